// A browser, or what says that it is one: requests, handshakes and frames, in pieces of any size, over a pair of sockets.
#include <array>
#include <cstdlib>
#include <string>
#include <string_view>

#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include "marey/core/error.h"
#include "marey/net/connection.h"

#include "fuzz.h"

using marey::fuzz::check;
namespace net = marey::net;

namespace {

class Counted : public net::Session {
 public:
  explicit Counted(std::size_t& received) : received_(received) {}

  std::size_t received(std::string_view bytes, net::Outbox&) override {
    received_ += bytes.size();
    return bytes.size();
  }
  net::HttpAnswer requested(const net::HttpRequest& request) override {
    for (const std::string& each : request.protocols) check(each.find('\n') == std::string::npos);
    if (request.upgrade) return {.upgrade = true, .protocol = request.protocols.empty() ? "" : "foxglove.sdk.v1"};
    return {.body = std::make_shared<const std::string>(request.target)};
  }
  void message(std::string_view bytes, net::Kind kind, net::Outbox& out) override {
    received_ += bytes.size();
    out.answer(std::string(bytes), kind);
  }

 private:
  std::size_t& received_;
};

net::Loop& loop() {
  static net::Loop* const made = [] {
    auto* loop = new net::Loop;
    loop->start();
    return loop;
  }();
  return *made;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = marey::fuzz::text_of(data, size);
  std::array<int, 2> pair{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair.data()) != 0) std::abort();
  const net::Descriptor ours(pair[0]);
  const timeval patience{.tv_sec = 0, .tv_usec = 100'000};  // a request may be whole for us and not for the server
  setsockopt(ours.get(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  std::size_t received = 0;
  std::shared_ptr<net::Connection> connection;
  {
    const std::scoped_lock lock(loop().mutex());
    connection = net::make_connection(loop(), net::Descriptor(pair[1]), {.protocol = net::Protocol::either},
                                      std::make_unique<Counted>(received));
    connection->start();
  }
  // Beside a handshake that is whole the frames come after its answer.
  const std::size_t head = text.find("\r\n\r\n");
  std::array<char, 65536> answer;
  for (std::size_t at = 0; at < size;) {
    std::size_t count = std::min<std::size_t>(37, size - at);
    if (head != std::string_view::npos && at < head + 4) count = std::min(count, head + 4 - at);
    if (send(ours.get(), text.data() + at, count, MSG_NOSIGNAL) <= 0) break;
    at += count;
    if (at == head + 4 && text.starts_with("GET ") && recv(ours.get(), answer.data(), answer.size(), 0) == 0) break;
    while (recv(ours.get(), answer.data(), answer.size(), MSG_DONTWAIT) > 0) {
    }
  }
  shutdown(ours.get(), SHUT_WR);
  while (recv(ours.get(), answer.data(), answer.size(), 0) > 0) {
  }
  const std::scoped_lock lock(loop().mutex());
  check(received <= size);
  connection->close();
  connection->forget_session();
  return 0;
}
