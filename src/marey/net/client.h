// A WebSocket to a server, for one thread: nothing happens but within its calls.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

namespace marey::net {

struct ClientOptions {
  std::size_t max_message = 65'536;         ///< bytes of one that is received
  std::chrono::milliseconds connect{2000};  ///< a server that is not there yet is tried again in the meantime
  std::chrono::milliseconds silence{0};     ///< a server that answers no ping within this time is gone; zero: no pings
};

class WebSocketClient {
 public:
  /// Throws Error, with a reason only, if nothing answers at HOST:PORT, or no WebSocket does; Stopped. `host` is a name or an
  /// address, one of IPv6 in brackets or without.
  WebSocketClient(const std::string& host, int port, const ClientOptions& options, const std::stop_token& stop);
  ~WebSocketClient();
  WebSocketClient(const WebSocketClient&) = delete;
  WebSocketClient& operator=(const WebSocketClient&) = delete;

  /// A text message; goes out at once, or within the next `receive`. Throws Error if the connection is gone.
  void send(const std::string& text);
  /// The next message; nothing if none comes within `wait`. Throws Error if the connection is gone.
  std::optional<std::string> receive(std::chrono::milliseconds wait);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace marey::net
