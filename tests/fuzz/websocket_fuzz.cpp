// A browser, or what says that it is one: handshake and frames, in pieces of any size.
#include <string>
#include <string_view>

#include "marey/core/error.h"
#include "marey/stream/websocket.h"

#include "fuzz.h"

using marey::fuzz::check;
namespace stream = marey::stream;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = marey::fuzz::text_of(data, size);
  stream::WebSocket socket({"foxglove.sdk.v1"});
  stream::Outbox out{stream::Descriptor()};  // goes nowhere
  std::string unread;
  std::size_t messages = 0;
  try {
    for (std::size_t at = 0; at < size; at += 37) {
      unread += text.substr(at, 37);
      while (const std::size_t done =
                 socket.received(unread, out, [] {}, [&](std::string_view message) { messages += message.size(); })) {
        check(done <= unread.size());
        unread.erase(0, done);
      }
    }
  } catch (const marey::Error& error) {
    marey::fuzz::check_message(error.what(), "");
  }
  check(messages <= size);
  return 0;
}
