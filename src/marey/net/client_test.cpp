#include "marey/net/client.h"

#include <array>
#include <functional>
#include <thread>

#include <gtest/gtest.h>
#include <sys/socket.h>

#include "marey/core/error.h"
#include "marey/core/stop.h"
#include "marey/net/server.h"

namespace marey::net {
namespace {

using namespace std::chrono_literals;

/// Answers a number with as many bytes, anything else with itself.
class Measured : public Session {
 public:
  HttpAnswer requested(const HttpRequest& request) override {
    return request.host.starts_with("127.0.0.1") && request.origin.empty() ? HttpAnswer{.upgrade = true} : refusal(403, "no");
  }
  void message(std::string_view bytes, Kind, Outbox& out) override {
    const int size = std::atoi(std::string(bytes).c_str());
    out.answer(size > 0 ? std::string(static_cast<std::size_t>(size), 'x') : std::string(bytes));
  }
};

class MeasuringServer {
 public:
  explicit MeasuringServer(std::uint16_t port = 0)
      : server_(loop_, Address{.host = kLoopback, .port = port}, "test", {.protocol = Protocol::web},
                [](const Address&) { return std::make_unique<Measured>(); }) {
    loop_.on_tick([this] { server_.tick(); });
    loop_.start();
  }
  ~MeasuringServer() { loop_.stop(); }
  std::uint16_t port() const { return server_.address().port; }

 private:
  Loop loop_;
  Server server_;
};

std::string next_message(WebSocketClient& client) {
  for (int i = 0; i < 50; ++i) {
    if (auto message = client.receive(100ms)) return *message;
  }
  return "nothing came";
}

/// A port where nothing listens.
std::uint16_t free_port() {
  Address at{.host = kLoopback, .port = 0};
  const Descriptor probe = listen_at(at, "test");
  return at.port;
}

TEST(WebSocketClient, SendsAndReceivesMessagesOfEverySize) {
  const MeasuringServer server;
  WebSocketClient client("127.0.0.1", server.port(), {.max_message = 5'000'000}, {});
  EXPECT_EQ(client.receive(0ms), std::nullopt);
  EXPECT_EQ(client.receive(20ms), std::nullopt);
  client.send("hello");
  EXPECT_EQ(next_message(client), "hello");
  client.send("");
  EXPECT_EQ(next_message(client), "");
  for (const int size : {1, 125, 126, 65'535, 65'536, 900'000}) client.send(std::to_string(size));
  for (const int size : {1, 125, 126, 65'535, 65'536, 900'000})
    EXPECT_EQ(next_message(client).size(), static_cast<std::size_t>(size));
}

TEST(WebSocketClient, WaitsForAServerThatIsNotThereYet) {
  const std::uint16_t port = free_port();
  std::optional<MeasuringServer> server;
  std::jthread later([&] {
    std::this_thread::sleep_for(200ms);
    server.emplace(port);
  });
  WebSocketClient client("127.0.0.1", port, {.connect = 3000ms}, {});
  client.send("there");
  EXPECT_EQ(next_message(client), "there");
}

TEST(WebSocketClient, GivesUpInTimeOrWhenItIsStopped) {
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_THROW(WebSocketClient("127.0.0.1", free_port(), {.connect = 200ms}, {}), Error);
  EXPECT_THROW(WebSocketClient("no.such.host.invalid", 80, {.connect = 200ms}, {}), Error);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(WebSocketClient("127.0.0.1", free_port(), {.connect = 60'000ms}, stop.get_token()), Stopped);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 20s);
}

TEST(WebSocketClient, NoticesThatTheServerHasGone) {
  std::optional<MeasuringServer> server(std::in_place);
  WebSocketClient client("127.0.0.1", server->port(), {}, {});
  server.reset();
  EXPECT_THROW(next_message(client), Error);
  EXPECT_THROW(client.send("hello"), Error);
}

/// A server of one connection that does what it is reported.
class RawServer {
 public:
  explicit RawServer(const std::function<void(int)>& serve)
      : listener_(listen_at(at_, "test")), thread_([this, serve] {
          for (int i = 0; i < 400; ++i) {
            Address peer;
            const Descriptor one = accept_from(listener_, peer);
            if (one) return serve(one.get());
            std::this_thread::sleep_for(5ms);
          }
        }) {}
  std::uint16_t port() const { return at_.port; }

 private:
  Address at_{.host = kLoopback, .port = 0};
  Descriptor listener_;
  std::jthread thread_;
};

void write_bytes(int socket, std::string_view bytes) {
  send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
}

TEST(WebSocketClient, RefusesAServerOfAnotherProtocol) {
  for (const std::string& greeting :
       {std::string("\xff\0\0\0\0\0\0\0\x01\x7f", 10), std::string("HTTP/1.1 200 OK\r\nContent-Length: 0\r\n\r\n"),
        std::string("HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                    "Sec-WebSocket-Accept: AAAAAAAAAAAAAAAAAAAAAAAAAAA=\r\n\r\n"),
        "HTTP/1.1 101 " + std::string(100'000, 'x')}) {
    RawServer server([&](int socket) {
      write_bytes(socket, greeting);
      std::this_thread::sleep_for(300ms);
    });
    EXPECT_THROW(WebSocketClient("127.0.0.1", server.port(), {.connect = 200ms}, {}), Error) << greeting.substr(0, 20);
  }
}

TEST(WebSocketClient, EndsWithAServerThatSendsTooMuchOrNothing) {
  const MeasuringServer server;
  WebSocketClient limited("127.0.0.1", server.port(), {.max_message = 1000}, {});
  limited.send("1001");
  EXPECT_THROW(next_message(limited), Error);
  // One that opens the WebSocket and then answers no ping.
  RawServer silent([](int socket) {
    std::string request;
    std::array<char, 4096> bytes;
    while (request.find("\r\n\r\n") == std::string::npos) {
      const ssize_t got = recv(socket, bytes.data(), bytes.size(), 0);
      if (got > 0) request.append(bytes.data(), static_cast<std::size_t>(got));
      if (got == 0) return;
    }
    write_bytes(socket, "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n\r\n");
    std::this_thread::sleep_for(300ms);
  });
  EXPECT_THROW(WebSocketClient("127.0.0.1", silent.port(), {.connect = 200ms}, {}), Error) << "no answer to the key";
}

}  // namespace
}  // namespace marey::net
