// A TCP server that no client can hold up: frames go out newest first where a client is slow, and what it did not take is counted.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <memory>
#include <string>
#include <string_view>

#include "marey/stream/loop.h"
#include "marey/stream/socket.h"

namespace marey::stream {

/// What is on its way to one client. Answers go out in order and are never dropped: who leaves more than `kMostUnread` of them
/// unread is sent off. Frames wait in a queue of `kMostFrames`; a newer one takes the place of the oldest that was not begun.
class Outbox {
 public:
  static constexpr std::size_t kMostUnread = std::size_t{1} << 20;
  static constexpr std::size_t kMostFrames = 4;

  explicit Outbox(Descriptor socket) : socket_(std::move(socket)) {}

  void answer(std::string bytes);
  /// `body` is shared by all clients; `head` is this one's.
  void frame(std::string head, std::shared_ptr<const std::string> body);
  /// Closes when what is there has gone out.
  void end() { ending_ = true; }

  std::int64_t frames_sent() const { return sent_; }
  std::int64_t frames_dropped() const { return dropped_; }

 private:
  friend class Server;
  struct Message {
    std::string head;
    std::shared_ptr<const std::string> body;  // none of an answer
  };

  /// As much as the socket takes at once.
  void flush();
  bool empty() const { return waiting_.empty(); }
  bool over() const { return gone_ || (ending_ && waiting_.empty()); }

  Descriptor socket_;
  std::deque<Message> waiting_;
  std::size_t begun_ = 0;  // bytes of the first that have gone out
  std::size_t frames_ = 0, unread_ = 0;
  bool gone_ = false, ending_ = false;
  std::int64_t sent_ = 0, dropped_ = 0;
};

/// One client's side of a protocol.
class Session {
 public:
  virtual ~Session() = default;
  virtual void joined(Outbox& /*out*/) {}
  /// What came and was not taken yet; returns how many bytes are done with. Throws Error where the client speaks no such protocol:
  /// it is sent off.
  virtual std::size_t received(std::string_view bytes, Outbox& out) = 0;
  /// Ten times a second.
  virtual void tick(Outbox& /*out*/) {}
};

class Server {
 public:
  struct Counts {
    std::int64_t clients = 0;    ///< that came
    std::int64_t now = 0;        ///< that are there
    std::int64_t refused = 0;    ///< too many at once
    std::int64_t sent_off = 0;   ///< that spoke another protocol, or read nothing
    std::int64_t sent = 0;       ///< frames, over all clients
    std::int64_t dropped = 0;    ///< frames that a client was too slow for
    std::string last_complaint;  ///< about who was sent off last
  };
  using Make = std::function<std::unique_ptr<Session>(const Address& client)>;

  /// More clients than `most_clients` are turned away, more than `most_bytes` from one that make no message send it off. Throws
  /// Error, which begins with `what`, where the port cannot be had. The loop must outlive it.
  Server(Loop& loop, Address at, const std::string& what, std::size_t most_clients, std::size_t most_bytes, Make make);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  const Address& address() const { return at_; }

  // Under the loop's lock.
  void each(const std::function<void(Session&, Outbox&)>& what);
  Counts counts() const;
  void tick();
  /// Gives clients `ms` milliseconds at most to take what is on its way to them. Not under the lock.
  void drain(int ms);

 private:
  struct Client {
    Outbox out;
    std::unique_ptr<Session> session;
    std::string unread;
  };
  using Clients = std::list<Client>;

  void accept_all();
  void handle(Client& client, Loop::Events events);
  void read(Client& client);
  /// Sends what waits; false where the client is gone now.
  bool settle(Client& client);
  void remove(Client& client);

  Loop& loop_;
  Address at_;
  Descriptor listener_;
  std::size_t most_clients_, most_bytes_;
  Make make_;
  Clients clients_;
  Counts counts_;
};

}  // namespace marey::stream
