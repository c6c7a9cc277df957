#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <optional>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "marey/core/error.h"
#include "marey/core/limits.h"
#include "marey/core/stop.h"
#include "marey/source/live/jpeg_decoder.h"
#include "marey/source/live/node.h"
#include "marey/source/live/node_clock.h"
#include "marey/source/live/node_sockets.h"

namespace marey::source::live {
namespace {

constexpr double kAnswersWithin = 2;                   // s
constexpr std::chrono::milliseconds kAskOften{20};     // between the first questions, which find the node's clock
constexpr std::chrono::milliseconds kAskSeldom{1000};  // between those that keep it
constexpr int kFirstQuestions = 8;
constexpr std::chrono::seconds kSetWithin{1};
constexpr std::chrono::milliseconds kAskWhetherSet{5};
constexpr double kOldest = 60;  // s that a frame may be old by the node's clock; else it counts as taken when it came
constexpr int kWaiting = 8;     // frames that are kept for a host that is late; the rest is let go
constexpr std::int64_t kLongestFrame = 256 << 20;
constexpr std::int64_t kLongestAnswer = 16 << 20;

zmq::socket_t open_questions(zmq::context_t& context, const NodePlace& place) {
  zmq::socket_t socket(context, zmq::socket_type::req);
  socket.set(zmq::sockopt::linger, 0);
  socket.set(zmq::sockopt::ipv6, 1);
  socket.set(zmq::sockopt::req_relaxed, 1);  // an answer that never comes ends nothing
  socket.set(zmq::sockopt::req_correlate, 1);
  socket.set(zmq::sockopt::maxmsgsize, kLongestAnswer);
  socket.connect(place.questions());
  return socket;
}

/// The answer to one question. Throws Error where none comes in time; Stopped.
std::string answer_to(const std::string& question, zmq::socket_t& questions, const NodePlace& place, const std::stop_token& stop) {
  questions.send(zmq::buffer(question), zmq::send_flags::none);
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(kAnswersWithin);
  while (std::chrono::steady_clock::now() < end) {
    if (stop.stop_requested()) throw Stopped();
    wait_for_any(std::array{std::ref(questions)}, kStopSlice);
    if (const auto answer = last_part(questions)) return std::string(text_in(*answer));
  }
  throw Error("{}: does not answer; does marey node run there, and may its ports {} and {} be reached?", place.node(), place.port,
              place.port + 1);
}

class NodeCamera final : public Connection {
 public:
  NodeCamera(NodePlace place, LiveTime& time, const std::stop_token& stop)
      : place_(std::move(place)),
        time_(time),
        stop_(stop),
        context_(node_context()),
        questions_(open_questions(*context_, place_)),
        frames_(*context_, zmq::socket_type::sub) {
    info_.name = fmt::format("{}/{}", place_.node(), place_.camera);
    const Timestamp asked = time_.now();
    const NodeAnswer answer = read_node_answer(answer_to(place_.camera, questions_, place_, stop), place_.node());
    session_ = answer.session;
    learn(answer, asked);
    if (!answer.known)
      throw Error("{}: has no camera \"{}\"; it has {}", place_.node(), place_.camera,
                  answer.cameras.empty() ? "none" : fmt::format("{}", fmt::join(answer.cameras, ", ")));
    frames_.set(zmq::sockopt::linger, 0);
    frames_.set(zmq::sockopt::ipv6, 1);
    frames_.set(zmq::sockopt::rcvhwm, kWaiting);
    frames_.set(zmq::sockopt::maxmsgsize, kLongestFrame);
    frames_.set(zmq::sockopt::heartbeat_ivl, 500);  // a cable that is pulled is noticed
    frames_.set(zmq::sockopt::heartbeat_timeout, 1500);
    frames_.set(zmq::sockopt::subscribe, place_.camera + '\n');
    frames_.connect(place_.frames());
  }

  const SourceInfo& info() const override { return info_; }

  Came next(Shot& shot) override {
    ask_now_and_then();
    wait_for_any(std::array{std::ref(frames_), std::ref(questions_)}, pause());
    hear();
    const auto message = last_part(frames_);
    if (!message) return Came::nothing;
    const NodeFrame frame = read_node_frame(text_in(*message), info_.name);
    if (frame.session != session_) throw Error("{}: was started anew", place_.node());
    shot.sequence = frame.sequence;
    const Timestamp now = time_.now();
    if (const auto taken = clock_.here(frame.taken); taken && std::abs(seconds(now - *taken)) < kOldest) shot.taken = taken;
    if (frame.detections) {
      shot.given.detections = *frame.detections;
      return Came::frame;
    }
    gives_pictures_ = true;
    shot.given.frame.picture = decoder_.decode(frame.jpeg);
    return shot.given.frame.picture.empty() ? Came::damaged : Came::frame;
  }

  std::vector<ControlRange> controls() override {
    try {
      const auto said = ask({.camera = place_.camera, .wish = {}});
      return said ? said->has : std::vector<ControlRange>();
    } catch (const Error&) {
      return {};  // it has gone, which its frames tell
    }
  }

  void set(Control control, double value) override {
    if (control == Control::threshold && gives_pictures_) return;  // who gets them finds the markers
    const auto end = std::chrono::steady_clock::now() + kSetWithin;
    auto said = ask({.camera = place_.camera, .wish = NodeQuestion::Wish{control, value}});
    while (said && said->allowed && said->waits && std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_for(kAskWhetherSet);
      said = ask({.camera = place_.camera, .wish = {}});
    }
    const char* why = !said            ? "marey node there is of an older version; install this one there too"
                      : !said->allowed ? "marey node there was started without --allow-control"
                      : said->waits    ? "the camera is not live there; it is set when it is back"
                                       : nullptr;
    if (why != nullptr) throw Error("{}: its {} cannot be set from here: {}", info_.name, to_string(control), why);
    if (!said->refused.empty()) throw Error("{}: {}", info_.name, said->refused);
  }

 private:
  /// Nothing where the node knows nothing of controls.
  std::optional<NodeControls> ask(const NodeQuestion& question) {
    is_asked_ = false;  // the answer about the clock is not waited for
    const auto said = read_node_controls(answer_to(text_of(question), questions_, place_, stop_), place_.node());
    if (said && said->session != session_) throw Error("{}: was started anew", place_.node());
    return said;
  }

  void ask_now_and_then() {
    const Timestamp now = time_.now();
    if (asked_ && now - *asked_ < pause()) return;
    asked_ = now;
    is_asked_ = true;
    questions_.send(zmq::buffer(place_.camera), zmq::send_flags::dontwait);
  }

  std::chrono::milliseconds pause() const { return answers_ < kFirstQuestions ? kAskOften : kAskSeldom; }

  void hear() {
    if (!is_asked_) return;
    const auto message = last_part(questions_);
    if (!message) return;
    is_asked_ = false;
    const NodeAnswer answer = read_node_answer(text_in(*message), place_.node());
    if (answer.session != session_) throw Error("{}: was started anew", place_.node());
    learn(answer, *asked_);
  }

  void learn(const NodeAnswer& answer, Timestamp asked) {
    clock_.learn(asked, answer.now, time_.now());
    ++answers_;
    if (!answer.size.empty()) info_.size = answer.size;
    if (answer.rate_hz) info_.rate_hz = answer.rate_hz;
  }

  NodePlace place_;
  LiveTime& time_;
  std::stop_token stop_;
  std::shared_ptr<zmq::context_t> context_;  // outlives its sockets
  zmq::socket_t questions_, frames_;
  SourceInfo info_;
  JpegDecoder decoder_;
  NodeClock clock_;
  std::uint64_t session_ = 0;
  std::optional<Timestamp> asked_;
  bool gives_pictures_ = false;
  bool is_asked_ = false;  // and has not answered
  int answers_ = 0;
};

}  // namespace

bool has_nodes() {
  return true;
}

Connect connect_node(const NodePlace& place) {
  return [place](LiveTime& time, const std::stop_token& stop) -> std::unique_ptr<Connection> {
    try {
      return std::make_unique<NodeCamera>(place, time, stop);
    } catch (const zmq::error_t& error) {
      throw Error("{}: cannot be reached ({})", place.node(), error.what());
    }
  };
}

std::string ask_rig_of_node(const NodePlace& place) {
  try {
    const auto context = node_context();
    zmq::socket_t questions = open_questions(*context, place);
    return answer_to("", questions, place, StopScope::current());
  } catch (const zmq::error_t& error) {
    throw Error("{}: cannot be reached ({})", place.node(), error.what());
  }
}

}  // namespace marey::source::live
