// One client's connection, without Asio: what Server needs of it.
#pragma once

#include <memory>
#include <string>

#include "marey/net/server.h"

namespace marey::net {

/// All is called under the loop's mutex.
class Connection {
 public:
  virtual ~Connection() = default;

  /// Begins to read.
  virtual void start() = 0;
  virtual void tick() = 0;
  /// Closes the socket; the session is not called after it.
  virtual void close() = 0;
  bool is_over() const { return over_; }

  Session& session() { return *session_; }
  Outbox& out() { return out_; }
  const Outbox& out() const { return out_; }
  /// Why it was ended, if the client is to blame.
  const std::string& complaint() const { return complaint_; }
  /// The session goes before what it belongs to.
  void forget_session() { session_.reset(); }

 protected:
  explicit Connection(std::unique_ptr<Session> session) : session_(std::move(session)) {}

  std::unique_ptr<Session> session_;
  Outbox out_;
  std::string complaint_;
  bool over_ = false;
};

/// `socket` is connected and does not block.
std::shared_ptr<Connection> make_connection(Loop& loop, Descriptor socket, const ServerOptions& options,
                                            std::unique_ptr<Session> session);

}  // namespace marey::net
