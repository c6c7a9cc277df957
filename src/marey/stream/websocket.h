// The server's side of a WebSocket (RFC 6455), as little of it as streams need: no extensions, messages in one piece out, in any
// number of pieces in. Browsers let any page open one to this host: a foreign page is refused by its Origin, a foreign name for
// this host (DNS rebinding) by its Host.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "marey/stream/server.h"

namespace marey::stream {

/// The head of a request as it matters here.
struct Upgrade {
  std::string key, host, origin;
  std::vector<std::string> protocols;
};

/// Throws Error where it asks for no WebSocket.
Upgrade parse_upgrade(std::string_view head);
std::string base64(std::string_view bytes);
/// The answer to a key: base64 of SHA-1 (RFC 6455, 4.2.2).
std::string accept_key(std::string_view key);
/// Whether a page of that origin may read what is measured on this host: none, a local one, a file, Foxglove's own.
bool is_trusted_origin(std::string_view origin);
/// Whether it names this host by address, or as localhost.
bool is_plain_host(std::string_view host);

enum class Opcode : std::uint8_t { more = 0, text = 1, binary = 2, close = 8, ping = 9, pong = 10 };

/// What stands before a payload of so many bytes.
std::string frame_head(Opcode opcode, std::size_t size);

/// A client's frame, unmasked.
struct ClientFrame {
  Opcode opcode = Opcode::text;
  bool last = true;
  std::string payload;
};
/// How many bytes it took; 0 where it is not whole yet. Throws Error for what no client may send, and beyond `most` bytes.
std::size_t parse_frame(std::string_view bytes, std::size_t most, ClientFrame& frame);

/// One connection: shakes hands, then hands messages on.
class WebSocket {
 public:
  static constexpr std::size_t kMostMessage = 65'536;

  /// One of `protocols` must be asked for; any, or none, where there are none.
  explicit WebSocket(std::vector<std::string> protocols = {}) : protocols_(std::move(protocols)) {}

  bool is_open() const { return open_; }
  /// As Session's. `opened` is called once, `message` for each whole message.
  std::size_t received(std::string_view bytes, Outbox& out, const std::function<void()>& opened,
                       const std::function<void(std::string_view)>& message);

 private:
  std::size_t shake_hands(std::string_view bytes, Outbox& out);
  void take(const ClientFrame& frame, Outbox& out, const std::function<void(std::string_view)>& message);

  std::vector<std::string> protocols_;
  bool open_ = false;
  std::string pieces_;
};

}  // namespace marey::stream
