#include <array>
#include <cerrno>
#include <functional>
#include <thread>
#include <utility>

#include "marey/core/error.h"
#include "marey/core/stop.h"
#include "marey/source/live/node.h"
#include "marey/source/live/node_sockets.h"

namespace marey::source::live {
namespace {

constexpr int kWaitingToGo = 4;                  // frames for a host that is late; the rest is let go
constexpr std::int64_t kLongestQuestion = 4096;  // bytes

/// Who answers what.
struct Answers {
  NodeServer::Answer answer;
  NodeServer::RigText rig;
  NodeServer::Set set;

  std::string to(const std::string& question) const {
    if (question.empty()) return rig();
    const auto about = set ? read_node_question(question) : std::nullopt;
    const auto controls = about ? set(*about) : std::nullopt;
    return controls ? message_of(*controls) : message_of(answer(question));
  }
};

/// Answers until it is stopped.
void answer_questions(const std::stop_token& stop, zmq::socket_t& questions, const Answers& answers) {
  while (!stop.stop_requested()) {
    wait_for_any(std::array{std::ref(questions)}, kStopSlice);
    const auto question = last_part(questions);
    if (!question) continue;
    const std::string said = answers.to(std::string(text_in(*question)));
    questions.send(zmq::buffer(said), zmq::send_flags::dontwait);
  }
}

}  // namespace

struct NodeServer::Parts {
  Parts(const NodePlace& place, Answers answers)
      : context(node_context()), frames(*context, zmq::socket_type::pub), questions(*context, zmq::socket_type::rep) {
    for (zmq::socket_t* socket : {&frames, &questions}) {
      socket->set(zmq::sockopt::linger, 0);
      socket->set(zmq::sockopt::ipv6, place.host.find(':') != std::string::npos);
      socket->set(zmq::sockopt::maxmsgsize, kLongestQuestion);
    }
    frames.set(zmq::sockopt::sndhwm, kWaitingToGo);
    frames.set(zmq::sockopt::immediate, 1);
    frames.set(zmq::sockopt::heartbeat_ivl, 500);
    frames.set(zmq::sockopt::heartbeat_timeout, 1500);
    frames.bind(place.frames());
    questions.bind(place.questions());
    answering = std::jthread([this, answers = std::move(answers)](const std::stop_token& stop) {
      try {
        answer_questions(stop, questions, answers);
      } catch (const zmq::error_t&) {  // the socket is gone: hosts find that it does not answer
      }
    });
  }

  std::shared_ptr<zmq::context_t> context;  // outlives its sockets
  zmq::socket_t frames, questions;
  std::jthread answering;  // ends before them
};

NodeServer::NodeServer(const std::string& address, int port, Answer answer, RigText rig, Set set) {
  const NodePlace place{.host = address, .port = port, .camera = {}};
  try {
    parts_ = std::make_unique<Parts>(place, Answers{std::move(answer), std::move(rig), std::move(set)});
  } catch (const zmq::error_t& error) {
    if (error.num() == ENODEV || error.num() == EADDRNOTAVAIL)
      throw Error("{}: is no address of this computer; write one as a number, 127.0.0.1, or 0.0.0.0 for all of them", address);
    throw Error("{}: ports {} and {} cannot be had ({}); name another with --port", address, port, port + 1, error.what());
  }
}

NodeServer::~NodeServer() = default;

void NodeServer::send(const std::string& camera, const std::string& message) {
  const std::string topic = camera + '\n';
  parts_->frames.send(zmq::buffer(topic), zmq::send_flags::sndmore | zmq::send_flags::dontwait);
  parts_->frames.send(zmq::buffer(message), zmq::send_flags::dontwait);
}

}  // namespace marey::source::live
