// One thread answers the pages (net/loop.h); what `publish` brings comes from others, by way of one slot for each topic, so that a
// server that is busy delays no client and queues nothing.
#include "web_server.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <mutex>
#include <system_error>
#include <utility>
#include <vector>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <unistd.h>

#include "marey/core/error.h"
#include "marey/net/server.h"
#include "marey/net/token.h"

#include "access.h"

namespace marey::viewer {
namespace {

/// Bytes in the system: what lies there is old when it arrives.
constexpr net::ServerOptions kPages{.protocol = net::Protocol::web,
                                    .max_clients = 64,
                                    .max_message = 4096,
                                    .max_request = 8192,
                                    .send_buffer = 1 << 18,
                                    .silence = std::chrono::seconds(30)};
/// Nothing is loaded from elsewhere, and the page cannot be framed by another.
constexpr const char* kPolicy =
    "default-src 'self'; img-src 'self' blob: data:; style-src 'self' 'unsafe-inline'; frame-ancestors 'none'; base-uri 'none'";

/// The address by which others reach a machine that listens on all of its own.
std::string first_outer_address() {
  for (const std::uint32_t host : net::own_hosts()) {
    if (!net::Address{.host = host, .port = 0}.is_loopback()) return net::host_text(host);
  }
  return "127.0.0.1";
}

std::vector<std::string> names_of_this_machine() {
  std::array<char, 256> name{};
  if (gethostname(name.data(), name.size() - 1) != 0 || name.front() == '\0') return {};
  return {name.data(), std::string(name.data()) + ".local"};
}

/// With the fields that every answer has.
net::HttpAnswer http_answer(int status, std::string type, Bytes body) {
  return {.status = status,
          .type = std::move(type),
          .body = std::move(body),
          .fields = {{"Cache-Control", "no-store"},
                     {"Content-Security-Policy", kPolicy},
                     {"X-Content-Type-Options", "nosniff"},
                     {"Referrer-Policy", "no-referrer"},
                     {"Cross-Origin-Resource-Policy", "same-origin"}}};
}

net::HttpAnswer page_refusal(int status, const std::string& message_text) {
  net::HttpAnswer answer = http_answer(status, "text/plain; charset=utf-8", bytes_of(message_text + "\n"));
  answer.keep = false;
  return answer;
}

}  // namespace

class WebServer::Core {
 public:
  Core(const ListenAddress& location, Handlers handlers);
  ~Core() { loop_.stop(); }

  void start() { loop_.start(); }
  std::string address() const;
  void publish(Message message, std::function<bool(PageId)> needs);
  void send(PageId page, const Message& message);
  Count count() const { return {sent_, dropped_, pages_}; }

 private:
  class Page;
  struct Published {
    Message message;
    std::function<bool(PageId)> needs;
  };

  net::Descriptor listen(const ListenAddress& location);
  void hand_out();
  void tick();
  void put(net::Outbox& out, const Message& message) {
    out.frame_of_topic(message.topic, {.body = message.bytes, .kind = message.text ? net::Kind::text : net::Kind::binary});
  }

  Handlers handlers_;
  std::optional<Access> access_;
  std::string shown_host_;
  std::atomic<std::uint64_t> sent_ = 0, dropped_ = 0;  // as of the last tick: a query never waits
  std::atomic<int> pages_ = 0;
  std::uint64_t last_page_ = 0;
  std::map<PageId, net::Outbox*> open_;

  std::mutex mutex_;
  std::map<int, Published> published_;  // by topic: the newest
  bool waking_ = false;

  // Destroyed first, with the pages, which refer to the members above.
  net::Loop loop_;
  net::Server server_;
};

/// A connection that asks by HTTP, and may become a page.
class WebServer::Core::Page : public net::Session {
 public:
  explicit Page(Core& core) : core_(core) {}
  ~Page() override {
    if (!id_) return;
    core_.open_.erase(*id_);
    --core_.pages_;
    if (core_.handlers_.left) core_.handlers_.left(*id_);
  }

  net::HttpAnswer requested(const net::HttpRequest& request) override {
    const Access::Verdict verdict = core_.access_->check(request);
    if (verdict.status != 200) return page_refusal(verdict.status, verdict.message_text);
    if (request.upgrade) {
      if (net::path_of(request.target) != "/socket") return page_refusal(404, "there is no such socket");
      return {.upgrade = true};
    }
    if (request.method != "GET" && request.method != "HEAD") return page_refusal(405, "there is nothing to be changed here");
    WebAnswer given = core_.handlers_.get(request.target);
    net::HttpAnswer answer = http_answer(given.status, std::move(given.type), std::move(given.body));
    if (verdict.by_link) answer.fields.emplace_back("Set-Cookie", core_.access_->set_cookie());
    return answer;
  }

  void opened(net::Outbox& out) override {
    id_ = PageId{++core_.last_page_};
    core_.open_[*id_] = &out;
    ++core_.pages_;
    if (core_.handlers_.joined) core_.handlers_.joined(*id_);
  }

  void message(std::string_view text, net::Kind kind, net::Outbox&) override {
    if (core_.handlers_.received && kind == net::Kind::text) core_.handlers_.received(*id_, text);
  }

 private:
  Core& core_;
  std::optional<PageId> id_;  // of an open WebSocket
};

WebServer::Core::Core(const ListenAddress& location, Handlers handlers)
    : handlers_(std::move(handlers)),
      server_(loop_, listen(location), kPages, [this](const net::Address&) { return std::make_unique<Page>(*this); }) {
  loop_.on_tick([this] { tick(); });
}

net::Descriptor WebServer::Core::listen(const ListenAddress& location) {
  const std::string address = location.listen == "localhost" ? "127.0.0.1" : location.listen;
  const int required = location.port.value_or(kDefaultPort);
  int port = required;
  std::optional<net::Descriptor> made = net::listen_at_digits(address, port);
  if (made && !*made && !location.port) {
    port = 0;
    made = net::listen_at_digits(address, port);
  }
  if (!made)
    throw Error("\"{}\" is not an address to listen on; give one of this machine's in digits, or 0.0.0.0 for all of them",
                location.listen);
  if (!*made)
    throw Error("{} port {}: cannot listen there ({}); --port 0 takes one that is free", location.listen, required,
                std::generic_category().message(errno));
  const bool everywhere = address == "0.0.0.0" || address == "::";
  const std::string host = everywhere ? first_outer_address() : address;
  shown_host_ = fmt::format(fmt::runtime(host.find(':') != std::string::npos ? "[{}]:{}" : "{}:{}"), host, port);
  access_.emplace(net::new_token(), fmt::format("marey_{}", port), names_of_this_machine());
  return std::move(*made);
}

std::string WebServer::Core::address() const {
  return fmt::format("http://{}/?token={}", shown_host_, access_->token());
}

void WebServer::Core::publish(Message message, std::function<bool(PageId)> needs) {
  if (pages_ == 0) return;
  const std::lock_guard lock(mutex_);
  const int topic = message.topic;
  published_.insert_or_assign(topic, Published{std::move(message), std::move(needs)});
  if (std::exchange(waking_, true)) return;
  loop_.post([this] { hand_out(); });
}

void WebServer::Core::hand_out() {
  std::map<int, Published> published;
  {
    const std::lock_guard lock(mutex_);
    published.swap(published_);
    waking_ = false;
  }
  for (const auto& [topic, one] : published) {
    for (const auto& [id, out] : open_) {
      if (!one.needs || one.needs(id)) put(*out, one.message);
    }
  }
}

void WebServer::Core::tick() {
  server_.tick();
  const net::Server::Counts counts = server_.counts();
  sent_ = static_cast<std::uint64_t>(counts.sent);
  dropped_ = static_cast<std::uint64_t>(counts.dropped);
}

void WebServer::Core::send(PageId page, const Message& message) {
  if (const auto found = open_.find(page); found != open_.end()) put(*found->second, message);
}

WebServer::WebServer(const ListenAddress& location, Handlers handlers)
    : core_(std::make_unique<Core>(location, std::move(handlers))) {}
WebServer::~WebServer() = default;
void WebServer::start() {
  core_->start();
}
std::string WebServer::address() const {
  return core_->address();
}
void WebServer::publish(Message message, std::function<bool(PageId)> needs) {
  core_->publish(std::move(message), std::move(needs));
}
void WebServer::send(PageId page, Message message) {
  core_->send(page, std::move(message));
}
WebServer::Count WebServer::count() const {
  return core_->count();
}

}  // namespace marey::viewer
