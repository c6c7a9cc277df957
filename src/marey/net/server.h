// A TCP server that no client can hold up: frames go out newest first where a client is slow, and what it did not take is counted.
// A connection is a byte stream, or HTTP that may become a WebSocket (RFC 6455, Boost.Beast); both on one port by the first
// bytes.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <string>
#include <string_view>

#include "marey/net/http.h"
#include "marey/net/loop.h"
#include "marey/net/outbox.h"
#include "marey/net/socket.h"

namespace marey::net {

class Connection;

/// One client's side of a protocol. All is called under the loop's mutex.
class Session {
 public:
  virtual ~Session() = default;

  /// A client of a byte stream is there.
  virtual void joined(Outbox& /*out*/) {}
  /// Bytes that came and were not taken yet; returns how many are done with. Throws Error if the client does not speak the
  /// protocol: it is disconnected.
  virtual std::size_t received(std::string_view bytes, Outbox& out);

  /// A request of HTTP. The default is a refusal.
  virtual HttpAnswer requested(const HttpRequest& request);
  /// The WebSocket that the answer allowed is open.
  virtual void opened(Outbox& /*out*/) {}
  /// A whole message. Throws Error as `received` does.
  virtual void message(std::string_view /*bytes*/, Kind /*kind*/, Outbox& /*out*/) {}

  /// Every 100 ms.
  virtual void tick(Outbox& /*out*/) {}
};

/// What a server's clients speak. `either`: HTTP if the first bytes are "GET "; a client that sends other bytes, or nothing for two
/// ticks, gets the byte stream.
enum class Protocol : std::uint8_t { bytes, web, either };

struct ServerOptions {
  Protocol protocol = Protocol::bytes;
  std::size_t max_clients = 64;       ///< more at a time are refused
  std::size_t max_bytes = 65'536;     ///< from one client that make no message of a byte stream; more disconnect it
  std::size_t max_message = 65'536;   ///< bytes of a WebSocket's message
  std::size_t max_request = 16'384;   ///< bytes of a request's head
  int send_buffer = 1 << 17;          ///< bytes in the system: they are old when a slow client reads them
  std::chrono::seconds patience{10};  ///< for a request, and for the opening of a WebSocket
  std::chrono::seconds idle{30};      ///< for the next request, and for a client that takes its answer
  /// A client of a WebSocket that answers no ping within this time is disconnected; zero: no pings.
  std::chrono::milliseconds silence{0};
};

class Server {
 public:
  struct Counts {
    std::int64_t clients = 0;         ///< that came
    std::int64_t now = 0;             ///< that are there
    std::int64_t refused = 0;         ///< too many at once
    std::int64_t disconnected = 0;    ///< that spoke another protocol, or read nothing
    std::int64_t sent = 0;            ///< frames, over all clients
    std::int64_t dropped = 0;         ///< frames that a client was too slow for
    std::string last_complaint = {};  ///< about the client that was disconnected last
  };
  using Make = std::function<std::unique_ptr<Session>(const Address& client)>;

  /// Serves the clients of a listening socket. The loop must outlive it.
  Server(Loop& loop, Descriptor listener, const ServerOptions& options, Make make);
  /// Listens first. Throws Error, which begins with `what`, if the port cannot be had.
  Server(Loop& loop, Address at, const std::string& what, const ServerOptions& options, Make make);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Of the second constructor, with the port that it got.
  const Address& address() const { return at_; }

  // Under the loop's mutex.
  void each(const std::function<void(Session&, Outbox&)>& what);
  Counts counts() const;
  void tick();

  // Not under the mutex.
  /// Gives clients `ms` milliseconds at most to take their pending data.
  void drain(int ms);

 private:
  bool accept_all();
  /// Takes those out that are over.
  void sweep();

  Loop& loop_;
  Address at_;
  Descriptor listener_;
  ServerOptions options_;
  Make make_;
  std::list<std::shared_ptr<Connection>> connections_;
  Counts counts_;
  bool full_ = false;  // was so when clients were to be accepted, which was put off once
};

}  // namespace marey::net
