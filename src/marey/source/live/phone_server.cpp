#include "marey/source/live/phone_server.h"

#include <bit>
#include <charconv>
#include <cmath>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <map>
#include <mutex>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/net/server.h"
#include "marey/net/tls_front.h"
#include "marey/net/token.h"
#include "marey/source/live/node_clock.h"
#include "marey/source/live/phone_page.h"

namespace marey::source::live {
namespace {

constexpr std::size_t kPhoneHead = 16;                         // bytes before the JPEG
constexpr std::size_t kMaxPhoneImage = std::size_t{16} << 20;  // bytes
constexpr std::size_t kMaxPhoneText = 200;                     // characters of what a phone says of itself
constexpr std::size_t kPhoneImagesKept = 4;                    // of each phone, not read yet; older ones are dropped
constexpr int kPhoneTicksBetween = 10;                         // of 100 ms, between questions for the clock
constexpr int kPhoneFirstTicks = 20;                           // of each tick at first, which find the clock
constexpr net::ServerOptions kPhones{
    .protocol = net::Protocol::web, .max_clients = 64, .max_message = kMaxPhoneImage, .silence = std::chrono::seconds(5)};
/// Nothing is loaded from elsewhere.
constexpr const char* kPhonePolicy =
    "default-src 'self'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src 'self' blob: data:; media-src 'self' "
    "blob:; "
    "connect-src 'self'; frame-ancestors 'none'; base-uri 'none'";

static_assert(std::endian::native == std::endian::little);

Timestamp steady_now() {
  return Timestamp(std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch()));
}

template <typename T>
T number_at(std::string_view bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// A phone's clock counts ms from its own origin.
std::optional<Timestamp> phone_time(double ms) {
  constexpr double kLongest = 1e13;  // ms, three hundred years
  if (!(std::abs(ms) < kLongest)) return std::nullopt;
  return Timestamp(duration_from_seconds(ms / 1000));
}

/// One camera that a phone may be. All under the server's mutex.
struct PhoneSlot {
  std::deque<PhoneImage> images;
  NodeClock clock;
  PhoneState state;
  std::string page;                    // that is it now, or was last: it names itself, and continues its numbers on a new line
  std::string numbered;                // the page that gave the last image
  std::int64_t before = 0, last = -1;  // added to that page's numbers, so that they continue from page to page; the last that came
  std::string size;                    // "1280x720": of its first image
  net::Session* session = nullptr;     // of the phone that is it now
};

}  // namespace

std::span<const std::uint8_t> PhoneImage::jpeg() const {
  return {reinterpret_cast<const std::uint8_t*>(message.data()) + kPhoneHead, message.size() - kPhoneHead};
}

struct PhoneServer::Parts {
  class Phone;

  explicit Parts(int port);
  ~Parts() { loop.stop(); }
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  std::string token = net::new_token();
  mutable std::mutex mutex;
  std::condition_variable came;
  std::map<std::string, PhoneSlot, std::less<>> slots;
  // Destroyed first, with the sessions, which refer to the members above.
  net::Loop loop;
  net::Server server;
  net::TlsFront front;
};

/// A phone's browser: it asks for the page, then becomes a camera.
class PhoneServer::Parts::Phone : public net::Session {
 public:
  explicit Phone(Parts& parts) : parts_(parts) {}
  ~Phone() override {
    const std::lock_guard lock(parts_.mutex);
    if (PhoneSlot* slot = own_slot()) {
      slot->session = nullptr;
      slot->state.connected = false;
      parts_.came.notify_all();
    }
  }

  net::HttpAnswer requested(const net::HttpRequest& request) override {
    if (!request.origin.empty() && request.origin != "https://" + request.host && request.origin != "http://" + request.host)
      return net::refusal(403, "asked by a page of another site");
    if (!net::same_secret(net::query_value(request.target, "token"), parts_.token))
      return net::refusal(401, "open the whole address that marey printed, with its token");
    const std::string_view path = net::path_of(request.target);
    if (request.upgrade) {
      if (path != "/camera") return net::refusal(404, "there is no such socket");
      camera_ = net::query_value(request.target, "camera");
      page_ = net::query_value(request.target, "page").substr(0, kMaxPhoneText);
      if (page_.empty()) page_ = net::new_token();
      const std::lock_guard lock(parts_.mutex);
      if (!parts_.slots.contains(camera_)) return net::refusal(404, "no camera of that name is wanted");
      return {.upgrade = true};
    }
    if (path == "/cameras") return answer_with("text/plain; charset=utf-8", cameras());
    if (path == "/") return answer_with("text/html; charset=utf-8", std::string(phone_page()));
    return net::refusal(404, "there is nothing here");
  }

  void opened(net::Outbox& out) override {
    const std::lock_guard lock(parts_.mutex);
    const auto found = parts_.slots.find(camera_);
    if (found == parts_.slots.end()) return out.end();
    PhoneSlot& slot = found->second;
    const bool again = page_ == slot.page;
    slot.state.stated = slot.session != nullptr && !again ? "another phone has taken its place" : "";
    slot.session = this;  // the phone that came last is the camera; another one notices at its next message
    slot.state.connected = true;
    if (!again) slot.clock = {};
    slot.page = page_;
    if (!slot.size.empty()) out.answer("size " + slot.size, net::Kind::text);
    query(out);
    parts_.came.notify_all();
  }

  void message(std::string_view bytes, net::Kind kind, net::Outbox& out) override {
    const Timestamp now = steady_now();
    const std::lock_guard lock(parts_.mutex);
    PhoneSlot* slot = own_slot();
    if (slot == nullptr) {
      out.answer("taken", net::Kind::text);
      return out.end();
    }
    if (kind == net::Kind::binary) return take_image(*slot, bytes);
    if (bytes.starts_with("clock ")) return take_clock(*slot, bytes.substr(6), now);
    if (bytes.starts_with("size ") && slot->size.empty()) slot->size = bytes.substr(5, kMaxPhoneText);
    if (bytes.starts_with("state ")) slot->state.stated = bytes.substr(6, kMaxPhoneText);
  }

  void tick(net::Outbox& out) override {
    if (camera_.empty()) return;
    const std::lock_guard lock(parts_.mutex);
    if (own_slot() == nullptr) return;
    ++ticks_;
    if (ticks_ < kPhoneFirstTicks || ticks_ % kPhoneTicksBetween == 0) query(out);
  }

 private:
  static net::HttpAnswer answer_with(const char* type, std::string body) {
    return {.type = type,
            .body = std::make_shared<const std::string>(std::move(body)),
            .fields = {{"Cache-Control", "no-store"},
                       {"Content-Security-Policy", kPhonePolicy},
                       {"X-Content-Type-Options", "nosniff"},
                       {"Referrer-Policy", "no-referrer"}}};
  }

  /// One line for each camera: "free left", "taken right".
  std::string cameras() const {
    std::string text;
    const std::lock_guard lock(parts_.mutex);
    for (const auto& [name, slot] : parts_.slots) text += fmt::format("{} {}\n", slot.session == nullptr ? "free" : "taken", name);
    return text;
  }

  /// Null if this phone is not a camera, or another one has come in its place.
  PhoneSlot* own_slot() const {
    const auto found = parts_.slots.find(camera_);
    return found != parts_.slots.end() && found->second.session == this ? &found->second : nullptr;
  }

  void query(net::Outbox& out) {
    requested_ = steady_now();
    out.answer(fmt::format("clock {}", ++question_), net::Kind::text);
  }

  /// "3 123456.25": the answer to the last question; a late one to an earlier question is not used.
  void take_clock(PhoneSlot& slot, std::string_view text, Timestamp now) {
    std::int64_t question = 0;
    const auto [rest, failed] = std::from_chars(text.data(), text.data() + text.size(), question);
    double ms = 0;
    if (failed != std::errc() || rest == text.data() + text.size() ||
        std::from_chars(rest + 1, text.data() + text.size(), ms).ec != std::errc())
      throw Error("its clock is no number");
    const auto reported = phone_time(ms);
    if (question != question_ || !reported) return;
    slot.clock.learn(requested_, *reported, now);
    slot.state.clock_s = slot.clock.uncertainty(now);
  }

  void take_image(PhoneSlot& slot, std::string_view bytes) {
    if (bytes.size() <= kPhoneHead) throw Error("an image without an image");
    const std::int64_t number = number_at<std::uint32_t>(bytes, 8);
    if (std::exchange(slot.numbered, page_) != page_) slot.before = slot.last + 1 - number;
    slot.last = slot.before + number;
    PhoneImage image{.message = std::string(bytes), .taken = {}, .sequence = slot.last};
    if (const auto taken = phone_time(number_at<double>(bytes, 0))) image.taken = slot.clock.here(*taken);
    slot.state.not_sent = number_at<std::uint32_t>(bytes, 12);
    ++slot.state.images;
    if (slot.images.size() == kPhoneImagesKept) slot.images.pop_front();
    slot.images.push_back(std::move(image));
    parts_.came.notify_all();
  }

  Parts& parts_;
  std::string camera_, page_;
  std::int64_t question_ = 0;
  Timestamp requested_{};
  int ticks_ = 0;
};

PhoneServer::Parts::Parts(int port)
    : server(loop, net::Address{.host = net::kLoopback, .port = 0}, "phones", kPhones,
             [this](const net::Address&) { return std::make_unique<Phone>(*this); }),
      front({.host = 0, .port = static_cast<std::uint16_t>(port)}, server.address().port, "phones") {
  loop.on_tick([this] { server.tick(); });
  loop.start();
}

namespace {

struct PhoneServers {
  std::mutex mutex;
  std::map<int, std::weak_ptr<PhoneServer>> by_port;
};
PhoneServers& phone_servers() {
  static PhoneServers servers;
  return servers;
}

}  // namespace

std::shared_ptr<PhoneServer> PhoneServer::at(int port) {
  PhoneServers& servers = phone_servers();
  const std::lock_guard lock(servers.mutex);
  if (auto there = servers.by_port[port].lock()) return there;
  auto made = std::make_shared<PhoneServer>(port);
  servers.by_port[port] = made;
  return made;
}

std::vector<std::shared_ptr<PhoneServer>> PhoneServer::all() {
  PhoneServers& servers = phone_servers();
  const std::lock_guard lock(servers.mutex);
  std::vector<std::shared_ptr<PhoneServer>> there;
  for (const auto& [port, server] : servers.by_port) {
    if (auto held = server.lock()) there.push_back(std::move(held));
  }
  return there;
}

PhoneServer::PhoneServer(int port) : parts_(std::make_unique<Parts>(port)) {}
PhoneServer::~PhoneServer() = default;

void PhoneServer::offer(const std::string& camera) {
  const std::lock_guard lock(parts_->mutex);
  const auto [at, is_new] = parts_->slots.try_emplace(camera);
  if (!is_new) throw Error("two cameras are the phone {}; give each phone its own name", camera);
  at->second.state.camera = camera;
}

void PhoneServer::forget(const std::string& camera) {
  const std::lock_guard lock(parts_->mutex);
  parts_->slots.erase(camera);
}

bool PhoneServer::is_connected(const std::string& camera) const {
  const std::lock_guard lock(parts_->mutex);
  const auto found = parts_->slots.find(camera);
  return found != parts_->slots.end() && found->second.session != nullptr;
}

std::optional<PhoneImage> PhoneServer::next(const std::string& camera, std::chrono::milliseconds wait) {
  std::unique_lock lock(parts_->mutex);
  const auto found = parts_->slots.find(camera);
  if (found == parts_->slots.end()) return std::nullopt;
  PhoneSlot& slot = found->second;
  parts_->came.wait_for(lock, wait, [&] { return !slot.images.empty() || slot.session == nullptr; });
  if (slot.images.empty()) return std::nullopt;
  PhoneImage image = std::move(slot.images.front());
  slot.images.pop_front();
  return image;
}

std::string PhoneServer::address() const {
  std::uint32_t shown = net::kLoopback;
  for (const std::uint32_t host : net::own_hosts()) {
    if (!net::Address{.host = host, .port = 0}.is_loopback()) {
      shown = host;
      break;
    }
  }
  return fmt::format("https://{}:{}/?token={}", net::host_text(shown), parts_->front.address().port, parts_->token);
}

const std::string& PhoneServer::fingerprint() const {
  return parts_->front.fingerprint();
}

std::vector<PhoneState> PhoneServer::states() const {
  const std::lock_guard lock(parts_->mutex);
  std::vector<PhoneState> states;
  for (const auto& [name, slot] : parts_->slots) states.push_back(slot.state);
  return states;
}

int PhoneServer::plain_port() const {
  return parts_->server.address().port;
}

}  // namespace marey::source::live
