#include <chrono>
#include <cmath>
#include <deque>
#include <optional>
#include <thread>
#include <type_traits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "marey/core/error.h"
#include "marey/core/stop.h"
#include "marey/files/limits.h"
#include "marey/net/client.h"
#include "marey/source/live/jpeg_decoder.h"
#include "marey/source/live/node.h"
#include "marey/source/live/node_clock.h"

namespace marey::source::live {
namespace {

constexpr double kAnswersWithin = 2;                     // s
constexpr std::chrono::milliseconds kQueryOften{20};     // between the first questions, which find the node's clock
constexpr std::chrono::milliseconds kQueryRarely{1000};  // between those that keep it
constexpr int kFirstQuestions = 8;
constexpr std::chrono::seconds kSetWithin{1};
constexpr std::chrono::milliseconds kQueryWhetherSet{5};
constexpr double kOldest = 60;       // s that a frame may be old by the node's clock; else it counts as taken when it came
constexpr std::size_t kWaiting = 8;  // frames that are kept for a host that is late; older ones are dropped
constexpr int kAtOnce = 256;         // messages that are read before frames are forwarded
constexpr std::size_t kLongestFrame = std::size_t{256} << 20;
constexpr std::size_t kLongestAnswer = std::size_t{16} << 20;
constexpr net::ClientOptions kLine{.max_message = kLongestFrame,
                                   .connect = std::chrono::milliseconds(2000),
                                   .silence = std::chrono::milliseconds(1500)};  // a cable that is pulled is noticed

/// The WebSocket to a node: questions, answers in their order, frames among them.
class NodeLine {
 public:
  /// Throws Error if the node does not answer in time; Stopped.
  NodeLine(const NodeAddress& location, const std::stop_token& stop)
      : location_(location), stop_(stop), client_(connected(location, stop)) {}

  void subscribe() {
    on_line([&] { client_->send(std::string(kFramesOf) + location_.camera); });
  }

  /// Its answer is waited for in `gather`.
  void request(const std::string& question) {
    on_line([&] { client_->send(question); });
    ++requested_;
    answer_.reset();
  }
  /// Of the last question; once.
  std::optional<std::string> answer() { return std::exchange(answer_, std::nullopt); }

  /// The answer to one question. Throws Error if none comes in time; Stopped.
  std::string answer_to(const std::string& question) {
    request(question);
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(kAnswersWithin);
    while (std::chrono::steady_clock::now() < end) {
      if (stop_.stop_requested()) throw Stopped();
      gather(kStopSlice);
      if (auto stated = answer()) return *stated;
    }
    refuse(location_);
  }

  /// Takes all messages that have come; waits for the first, unless frames are there or the last question is answered.
  void gather(std::chrono::milliseconds wait) {
    for (int i = 0; i < kAtOnce; ++i) {
      const bool waits = i == 0 && frames_.empty() && !answer_;
      auto message = on_line([&] { return client_->receive(waits ? std::min(wait, kStopSlice) : std::chrono::milliseconds(0)); });
      if (!message) return;
      if (is_node_frame(*message)) {
        if (frames_.size() == kWaiting) frames_.pop_front();
        frames_.push_back(std::move(*message));
        continue;
      }
      if (++answered_ > requested_ || message->size() > kLongestAnswer)
        throw Error("{}: it is not a node of Marey, or one of another version", location_.node());
      if (answered_ < requested_) continue;  // to a question whose caller has left
      answer_ = std::move(message);
      return;  // when it came matters
    }
  }

  /// The oldest that came and was not taken.
  std::optional<std::string> frame() {
    if (frames_.empty()) return std::nullopt;
    std::string first = std::move(frames_.front());
    frames_.pop_front();
    return first;
  }

 private:
  [[noreturn]] static void refuse(const NodeAddress& location) {
    throw Error("{}: does not answer; does marey node run there, and may its port {} be reached?", location.node(), location.port);
  }

  /// Says of which node an error is.
  template <typename Do>
  std::invoke_result_t<Do> on_line(Do what) {
    try {
      return what();
    } catch (const Error& error) {
      throw Error("{}: has gone ({})", location_.node(), error.what());
    }
  }

  static std::unique_ptr<net::WebSocketClient> connected(const NodeAddress& location, const std::stop_token& stop) {
    try {
      return std::make_unique<net::WebSocketClient>(location.host, location.port, kLine, stop);
    } catch (const Error&) {
      refuse(location);
    }
  }

  NodeAddress location_;
  std::stop_token stop_;
  std::unique_ptr<net::WebSocketClient> client_;
  std::deque<std::string> frames_;
  std::optional<std::string> answer_;
  std::int64_t requested_ = 0, answered_ = 0;
};

class NodeCamera final : public Connection {
 public:
  NodeCamera(NodeAddress location, LiveTime& time, const std::stop_token& stop)
      : location_(std::move(location)), time_(time), line_(location_, stop) {
    info_.name = fmt::format("{}/{}", location_.node(), location_.camera);
    const Timestamp requested = time_.now();
    const NodeAnswer answer = read_node_answer(line_.answer_to(location_.camera), location_.node());
    session_ = answer.session;
    learn(answer, requested);
    if (!answer.known)
      throw Error("{}: has no camera \"{}\"; it has {}", location_.node(), location_.camera,
                  answer.cameras.empty() ? "none" : fmt::format("{}", fmt::join(answer.cameras, ", ")));
    line_.subscribe();
  }

  const SourceInfo& info() const override { return info_; }

  Came next(Shot& shot) override {
    query_now_and_then();
    line_.gather(pause());
    listen();
    const auto message = line_.frame();
    if (!message) return Came::nothing;
    const NodeFrame frame = read_node_frame(*message, info_.name);
    if (frame.session != session_) throw Error("{}: was started again", location_.node());
    shot.sequence = frame.sequence;
    const Timestamp now = time_.now();
    if (const auto taken = clock_.here(frame.taken); taken && std::abs(seconds(now - *taken)) < kOldest) shot.taken = taken;
    if (frame.detections) {
      shot.given.detections = *frame.detections;
      return Came::frame;
    }
    gives_images_ = true;
    shot.given.frame.image = decoder_.decode(frame.jpeg);
    return shot.given.frame.image.empty() ? Came::damaged : Came::frame;
  }

  std::vector<ControlRange> controls() override {
    try {
      const auto stated = request({.camera = location_.camera, .request = {}});
      return stated ? stated->has : std::vector<ControlRange>();
    } catch (const Error&) {
      return {};  // it has gone, which its frames report
    }
  }

  void set(Control control, double value) override {
    if (control == Control::threshold && gives_images_) return;  // who gets them finds the markers
    const auto end = std::chrono::steady_clock::now() + kSetWithin;
    auto stated = request({.camera = location_.camera, .request = NodeQuestion::ControlRequest{control, value}});
    while (stated && stated->allowed && stated->waits && std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_for(kQueryWhetherSet);
      stated = request({.camera = location_.camera, .request = {}});
    }
    const char* why = !stated            ? "marey node there is of an older version; install this one there too"
                      : !stated->allowed ? "marey node there was started without --allow-control"
                      : stated->waits    ? "the camera is not live there; it is set when it is back"
                                         : nullptr;
    if (why != nullptr) throw Error("{}: its {} cannot be set from here: {}", info_.name, to_string(control), why);
    if (!stated->refused.empty()) throw Error("{}: {}", info_.name, stated->refused);
  }

 private:
  /// Nothing if the node knows nothing of controls.
  std::optional<NodeControls> request(const NodeQuestion& question) {
    is_requested_ = false;  // the answer about the clock is not waited for
    const auto stated = read_node_controls(line_.answer_to(text_of(question)), location_.node());
    if (stated && stated->session != session_) throw Error("{}: was started again", location_.node());
    return stated;
  }

  void query_now_and_then() {
    const Timestamp now = time_.now();
    if (requested_ && now - *requested_ < pause()) return;
    requested_ = now;
    is_requested_ = true;
    line_.request(location_.camera);
  }

  std::chrono::milliseconds pause() const { return answers_ < kFirstQuestions ? kQueryOften : kQueryRarely; }

  void listen() {
    if (!is_requested_) return;
    const auto message = line_.answer();
    if (!message) return;
    is_requested_ = false;
    const NodeAnswer answer = read_node_answer(*message, location_.node());
    if (answer.session != session_) throw Error("{}: was started again", location_.node());
    learn(answer, *requested_);
  }

  void learn(const NodeAnswer& answer, Timestamp requested) {
    clock_.learn(requested, answer.now, time_.now());
    ++answers_;
    if (!answer.size.empty()) info_.size = answer.size;
    if (answer.rate_hz) info_.rate_hz = answer.rate_hz;
  }

  NodeAddress location_;
  LiveTime& time_;
  NodeLine line_;
  SourceInfo info_;
  JpegDecoder decoder_;
  NodeClock clock_;
  std::uint64_t session_ = 0;
  std::optional<Timestamp> requested_;
  bool gives_images_ = false;
  bool is_requested_ = false;  // and has not answered
  int answers_ = 0;
};

}  // namespace

Connect connect_node(const NodeAddress& location) {
  return [location](LiveTime& time, const std::stop_token& stop) -> std::unique_ptr<Connection> {
    return std::make_unique<NodeCamera>(location, time, stop);
  };
}

std::string query_rig_of_node(const NodeAddress& location) {
  return NodeLine(location, StopScope::current()).answer_to("");
}

}  // namespace marey::source::live
