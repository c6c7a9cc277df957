#include <cerrno>
#include <system_error>
#include <utility>

#include "marey/core/error.h"
#include "marey/net/server.h"
#include "marey/source/live/node.h"

namespace marey::source::live {
namespace {

constexpr net::ServerOptions kHosts{.protocol = net::Protocol::web,
                                    .max_clients = 512,  // one for each camera of each host
                                    .max_message = 4096,
                                    .send_buffer = 1 << 18,
                                    .silence = std::chrono::seconds(5)};

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

/// One WebSocket of a host.
class HostSession : public net::Session {
 public:
  explicit HostSession(const Answers& answers) : answers_(answers) {}

  net::HttpAnswer requested(const net::HttpRequest& request) override {
    if (!request.upgrade) return net::refusal(400, "marey node speaks to marey live alone");
    if (!request.origin.empty()) return net::refusal(403, "pages may not see what cameras see");
    return {.upgrade = true};
  }

  void message(std::string_view question, net::Kind, net::Outbox& out) override {
    if (question.starts_with(kFramesOf)) {
      camera_ = question.substr(kFramesOf.size());
    } else {
      out.answer(answers_.to(std::string(question)));
    }
  }

  /// The one whose frames it gets; none before it subscribed.
  const std::string& camera() const { return camera_; }

 private:
  const Answers& answers_;
  std::string camera_;
};

net::Descriptor listen_for_hosts(const std::string& address, int port) {
  const bool brackets = address.size() > 2 && address.front() == '[' && address.back() == ']';
  int got = port;
  std::optional<net::Descriptor> made = net::listen_at_digits(brackets ? address.substr(1, address.size() - 2) : address, got);
  if (!made || (!*made && errno == EADDRNOTAVAIL))
    throw Error("{}: is not an address of this computer; write one as a number, 127.0.0.1, or 0.0.0.0 for all of them", address);
  if (!*made)
    throw Error("{}: port {} cannot be had ({}); name another with --port", address, port, std::generic_category().message(errno));
  return std::move(*made);
}

}  // namespace

struct NodeServer::Parts {
  Parts(const std::string& address, int port, Answers given)
      : answers(std::move(given)), server(loop, listen_for_hosts(address, port), kHosts, [this](const net::Address&) {
          return std::make_unique<HostSession>(answers);
        }) {
    loop.on_tick([this] { server.tick(); });
    loop.start();
  }
  ~Parts() { loop.stop(); }

  Answers answers;
  net::Loop loop;
  net::Server server;
};

NodeServer::NodeServer(const std::string& address, int port, Answer answer, RigText rig, Set set)
    : parts_(std::make_unique<Parts>(address, port, Answers{std::move(answer), std::move(rig), std::move(set)})) {}

NodeServer::~NodeServer() = default;

void NodeServer::send(const std::string& camera, const std::string& message) {
  const std::scoped_lock lock(parts_->loop.mutex());
  std::shared_ptr<const std::string> body;  // made if a host is there
  parts_->server.each([&](net::Session& session, net::Outbox& out) {
    if (static_cast<HostSession&>(session).camera() != camera) return;
    if (body == nullptr) body = std::make_shared<const std::string>(message);
    out.frame({.body = body});
  });
}

}  // namespace marey::source::live
