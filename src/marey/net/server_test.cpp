// Over real sockets of this host: bytes in pieces, frames of every size, masks, closes, slow clients, many, hostile ones.
#include "marey/net/server.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <thread>
#include <vector>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include "marey/core/error.h"

namespace marey::net {
namespace {

using namespace std::chrono_literals;

/// A client that waits for two seconds at most.
class TestSocket {
 public:
  explicit TestSocket(const Server& server, int receive_buffer = 0) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(server.address().port);
    to.sin_addr.s_addr = htonl(kLoopback);
    const timeval patience{.tv_sec = 2, .tv_usec = 0};
    setsockopt(socket_.get(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    if (receive_buffer > 0) setsockopt(socket_.get(), SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    if (connect(socket_.get(), reinterpret_cast<sockaddr*>(&to), sizeof to) != 0) socket_.reset();
  }

  void transmit(std::string_view bytes) { send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL); }
  /// A byte at a time, as a slow line brings them.
  void write_slowly(std::string_view bytes) {
    for (const char byte : bytes) {
      transmit({&byte, 1});
      std::this_thread::sleep_for(1ms);
    }
  }
  /// The next `size` bytes; fewer if the server closes, or says no more.
  std::string listen(std::size_t size) {
    std::string received(size, '\0');
    std::size_t got = 0;
    while (got < size) {
      const ssize_t more = recv(socket_.get(), received.data() + got, size - got, 0);
      if (more <= 0) break;
      got += static_cast<std::size_t>(more);
    }
    received.resize(got);
    return received;
  }
  std::string receive_until(std::string_view end) {
    std::string received;
    while (received.find(end) == std::string::npos) {
      const std::string more = listen(1);
      if (more.empty()) break;
      received += more;
    }
    return received;
  }
  /// Whether the server closes within the time that a client waits.
  bool is_closed() {
    for (;;) {
      std::array<char, 65536> bytes;
      const ssize_t got = recv(socket_.get(), bytes.data(), bytes.size(), 0);
      if (got == 0 || (got < 0 && errno == ECONNRESET)) return true;
      if (got < 0) return false;
    }
  }
  void reset() { socket_.reset(); }

 private:
  Descriptor socket_;
};

constexpr std::string_view kUpgrade =
    "GET /socket HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
    "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";

/// A client's frame (RFC 6455, 5.2) with a mask.
std::string masked(unsigned char first, std::string payload) {
  const std::array<char, 4> mask{'\x37', '\xfa', '\x21', '\x3d'};
  std::string frame(1, static_cast<char>(first));
  if (payload.size() < 126) {
    frame += static_cast<char>(0x80 | payload.size());
  } else if (payload.size() < 65'536) {
    frame += '\xfe';
    for (const int shift : {8, 0}) frame += static_cast<char>(payload.size() >> shift & 255);
  } else {
    frame += '\xff';
    for (int shift = 56; shift >= 0; shift -= 8) frame += static_cast<char>(payload.size() >> shift & 255);
  }
  frame.append(mask.data(), mask.size());
  for (std::size_t i = 0; i < payload.size(); ++i) frame += static_cast<char>(payload[i] ^ mask[i % 4]);
  return frame;
}

/// Says back what it receives: bytes up to each line break, or messages. A line "bad" breaks its protocol.
class Echo : public Session {
 public:
  void joined(Outbox& out) override { out.answer("hello\n"); }
  std::size_t received(std::string_view bytes, Outbox& out) override {
    const std::size_t end = bytes.find('\n');
    if (end == std::string_view::npos) return 0;
    if (bytes.substr(0, end) == "bad") throw Error("a bad line");
    if (bytes.substr(0, end) == "bye") out.end();
    out.answer(std::string(bytes.substr(0, end + 1)));
    return end + 1;
  }
  HttpAnswer requested(const HttpRequest& request) override {
    if (request.upgrade) return {.upgrade = true};
    if (request.target == "/") return {.body = std::make_shared<const std::string>(request.method + " " + request.host)};
    return refusal(404, "there is no such page");
  }
  void message(std::string_view bytes, Kind kind, Outbox& out) override {
    if (bytes == "bad") throw Error("a bad message");
    if (bytes == "bye") return out.end();
    out.answer(std::string(bytes), kind);
  }
};

class Served {
 public:
  explicit Served(ServerOptions options = {.protocol = Protocol::web})
      : server_(loop_, Address{.host = kLoopback, .port = 0}, "test", options,
                [](const Address&) { return std::make_unique<Echo>(); }) {
    loop_.on_tick([this] { server_.tick(); });
    loop_.start();
  }
  ~Served() { loop_.stop(); }

  Server& server() { return server_; }
  Server::Counts counts() {
    const std::scoped_lock lock(loop_.mutex());
    return server_.counts();
  }
  void send_all(const std::shared_ptr<const std::string>& body) {
    const std::scoped_lock lock(loop_.mutex());
    server_.each([&](Session&, Outbox& out) { out.frame({.body = body}); });
  }
  bool becomes(const std::function<bool(const Server::Counts&)>& required) {
    for (int i = 0; i < 400; ++i) {
      if (required(counts())) return true;
      std::this_thread::sleep_for(10ms);
    }
    return false;
  }

 private:
  Loop loop_;
  Server server_;
};

/// With a WebSocket that is open.
TestSocket opened(Served& served, int receive_buffer = 0) {
  TestSocket client(served.server(), receive_buffer);
  client.transmit(kUpgrade);
  EXPECT_TRUE(client.receive_until("\r\n\r\n").starts_with("HTTP/1.1 101 Switching Protocols\r\n"));
  return client;
}

TEST(Server, ReadsLinesInPieces) {
  Served served({.protocol = Protocol::bytes});
  TestSocket client(served.server());
  EXPECT_EQ(client.listen(6), "hello\n");
  client.write_slowly("one\ntwo\nth");
  EXPECT_EQ(client.listen(8), "one\ntwo\n");
  client.transmit("ree\nbye\nnot received\n");
  EXPECT_EQ(client.listen(10), "three\n");
  EXPECT_TRUE(client.is_closed());
}

TEST(Server, DisconnectsAClientOfAnotherProtocol) {
  Served served({.protocol = Protocol::bytes, .max_bytes = 1000});
  TestSocket bad(served.server()), endless(served.server()), good(served.server());
  bad.transmit("bad\n");
  EXPECT_TRUE(bad.is_closed());
  endless.transmit(std::string(5000, 'x'));
  EXPECT_TRUE(endless.is_closed());
  good.transmit("good\n");
  EXPECT_EQ(good.listen(11), "hello\ngood\n");
  EXPECT_TRUE(served.becomes([](const auto& counts) { return counts.disconnected == 2 && counts.now == 1; }));
  EXPECT_EQ(served.counts().last_complaint, "5000 bytes that make no message");
}

TEST(Server, AnswersRequestsOfHttp) {
  Served served;
  TestSocket client(served.server());
  client.write_slowly("GET / HTTP/1.1\r\nHost: here\r\n\r\n");
  EXPECT_NE(client.receive_until("GET here").find("Content-Length: 8\r\n"), std::string::npos);
  client.transmit("HEAD / HTTP/1.1\r\nHost: here\r\n\r\n");
  EXPECT_NE(client.receive_until("\r\n\r\n").find("Content-Length: 9\r\n"), std::string::npos);
  client.transmit("GET /other HTTP/1.1\r\nHost: here\r\n\r\n");
  EXPECT_TRUE(client.receive_until("no such page\n").starts_with("HTTP/1.1 404 Not Found\r\n"));
  EXPECT_TRUE(client.is_closed());
}

TEST(Server, RefusesWhatIsNoRequest) {
  Served served({.protocol = Protocol::web, .max_request = 1000});
  for (const std::string& wrong : {std::string("\xff\xff\xff\xff\r\n\r\n"), std::string("GET / HTTP/9.9\r\n\r\n"),
                                   "GET /" + std::string(5000, 'a') + " HTTP/1.1\r\n\r\n", std::string("bad\r\n\r\n"),
                                   "GET / HTTP/1.1\r\nContent-Length: 99\r\n\r\n" + std::string(99, 'x')}) {
    TestSocket client(served.server());
    client.transmit(wrong);
    EXPECT_TRUE(client.listen(12) == "HTTP/1.1 400" || client.is_closed());
    EXPECT_TRUE(client.is_closed());
  }
  TestSocket client(served.server());
  client.transmit("GET /socket HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n\r\n");
  EXPECT_FALSE(client.receive_until("\r\n\r\n").starts_with("HTTP/1.1 101"));
  TestSocket hasty(served.server());
  hasty.transmit(std::string(kUpgrade) + masked(0x81, "early"));
  EXPECT_TRUE(hasty.receive_until("\r\n\r\n").starts_with("HTTP/1.1 400"));
}

TEST(Server, ShakesHandsAsTheStandardsExample) {
  Served served;
  TestSocket client(served.server());
  client.write_slowly(kUpgrade);
  EXPECT_NE(client.receive_until("\r\n\r\n").find("Sec-WebSocket-Accept: s3pPLMBiTxaQ9kYGzzhZRbK+xOo=\r\n"), std::string::npos);
  // Clients that omit "Connection: Upgrade" were always served.
  TestSocket terse(served.server());
  std::string request(kUpgrade);
  request.erase(request.find("Connection: Upgrade\r\n"), 21);
  terse.transmit(request);
  EXPECT_TRUE(terse.receive_until("\r\n\r\n").starts_with("HTTP/1.1 101"));
}

TEST(Server, TakesMessagesOfEverySizeAndInPieces) {
  Served served;
  TestSocket client = opened(served);
  client.write_slowly(masked(0x81, "Hello"));
  EXPECT_EQ(client.listen(7), "\x81\x05Hello");
  client.transmit(masked(0x02, "in "));
  client.transmit(masked(0x89, "ping"));
  client.transmit(masked(0x80, "pieces"));
  EXPECT_EQ(client.listen(6), "\x8a\x04ping");
  EXPECT_EQ(client.listen(11), "\x82\x09in pieces");
  client.transmit(masked(0x82, std::string(300, 'm')));
  EXPECT_EQ(client.listen(304), std::string("\x82\x7e\x01\x2c", 4) + std::string(300, 'm'));
  client.transmit(masked(0x82, std::string(65'536, 'l')));
  EXPECT_EQ(client.listen(65'546), std::string("\x82\x7f\0\0\0\0\0\x01\0\0", 10) + std::string(65'536, 'l'));
}

TEST(Server, ClosesWithTheCodeOfWhatWasWrong) {
  Served served;
  const auto code_of = [&](const std::string& wrong) {
    TestSocket client = opened(served);
    client.transmit(wrong);
    const std::string received = client.listen(4);
    if (received.size() < 4 || received[0] != '\x88') return -1;
    EXPECT_TRUE(client.is_closed()) << wrong.substr(0, 20);
    return static_cast<unsigned char>(received[2]) << 8 | static_cast<unsigned char>(received[3]);
  };
  EXPECT_EQ(code_of(std::string("\x81\x05Hello")), 1002) << "no mask";
  EXPECT_EQ(code_of(masked(0xc1, "x")), 1002) << "a bit of an extension";
  EXPECT_EQ(code_of(masked(0x83, "x")), 1002) << "a frame of unknown kind";
  EXPECT_EQ(code_of(masked(0x09, "x")), 1002) << "a ping in pieces";
  EXPECT_EQ(code_of(masked(0x80, "x")), 1002) << "the rest of nothing";
  EXPECT_EQ(code_of(masked(0x89, std::string(126, 'x'))), 1002) << "a ping that is too long";
  EXPECT_EQ(code_of(masked(0x81, "\xff\xfe")), 1007) << "a text that is not UTF-8";
  EXPECT_EQ(code_of(std::string("\x82\xff\x7f\xff\xff\xff\xff\xff\xff\xff"
                                "mask",
                                14)),
            1009)
      << "2^63 bytes";
  EXPECT_EQ(code_of(masked(0x82, std::string(65'537, 'x'))), 1009) << "more than is taken";
  EXPECT_EQ(code_of(masked(0x81, "bad")), 1008);
  EXPECT_EQ(code_of(masked(0x88, std::string("\x03\xe9", 2))), 1001) << "its own code back";
  EXPECT_TRUE(served.becomes([](const auto& counts) { return counts.now == 0; }));
  EXPECT_EQ(served.counts().disconnected, 10);
}

TEST(Server, SaysGoodbye) {
  Served served;
  TestSocket client = opened(served);
  client.transmit(masked(0x81, "bye"));
  EXPECT_EQ(client.listen(4), std::string("\x88\x02\x03\xe8", 4));
  client.transmit(masked(0x88, std::string("\x03\xe8", 2)));
  EXPECT_TRUE(client.is_closed());
}

TEST(Server, TellsBytesFromHttpByTheFirstFour) {
  Served served({.protocol = Protocol::either});
  TestSocket web(served.server()), lines(served.server()), silent(served.server());
  web.write_slowly(kUpgrade);
  EXPECT_TRUE(web.receive_until("\r\n\r\n").starts_with("HTTP/1.1 101"));
  lines.transmit("GETS\n");
  EXPECT_EQ(lines.listen(11), "hello\nGETS\n");
  EXPECT_EQ(silent.listen(6), "hello\n");
  silent.transmit("GET / is a line now\n");
  EXPECT_EQ(silent.listen(20), "GET / is a line now\n");
}

TEST(Server, KeepsWholeFramesForASlowClientAndDropsTheRest) {
  for (const bool web : {false, true}) {
    Served served({.protocol = web ? Protocol::web : Protocol::bytes, .send_buffer = 4096});
    TestSocket quick = web ? opened(served) : TestSocket(served.server());
    TestSocket slow = web ? opened(served, 4096) : TestSocket(served.server(), 4096);
    if (!web) {
      quick.listen(6);
      slow.listen(6);
    }
    const std::size_t size = 20'000, head = web ? 4 : 0;
    for (int i = 0; i < 40; ++i) {
      const auto body = std::make_shared<const std::string>(std::string(size, static_cast<char>('A' + i)));
      served.send_all(body);
      ASSERT_EQ(quick.listen(head + size).substr(head), *body) << i;
    }
    const auto counts = served.counts();
    EXPECT_GT(counts.dropped, 20);
    EXPECT_EQ(counts.sent + counts.dropped + static_cast<std::int64_t>(Outbox::kMaxFrames), 80);
    char newest = 0;
    for (std::string frame = slow.listen(head + size); frame.size() == head + size;
         frame = newest < 'A' + 39 ? slow.listen(head + size) : "") {
      const std::string_view body = std::string_view(frame).substr(head);
      EXPECT_EQ(body.find_first_not_of(body.front()), std::string::npos) << "a frame is whole";
      EXPECT_GT(body.front(), newest);
      newest = body.front();
    }
    EXPECT_EQ(newest, 'A' + 39) << "the newest arrives; WebSocket: " << web;
  }
}

TEST(Server, DisconnectsAClientThatAsksAndReadsNothing) {
  Served served;
  TestSocket client = opened(served, 4096);
  const std::string question = masked(0x82, std::string(60'000, 'q'));
  for (int i = 0; i < 200 && served.counts().now > 0; ++i) client.transmit(question);
  EXPECT_TRUE(served.becomes([](const auto& counts) { return counts.now == 0; }));
  EXPECT_EQ(served.counts().last_complaint, "left its answers unread");
}

TEST(Server, ReadsNoMoreFromAClientThatPingsAndReadsNothing) {
  Served served({.protocol = Protocol::web, .send_buffer = 4096});
  TestSocket client = opened(served, 4096);
  std::string pings;
  for (int i = 0; i < 500; ++i) pings += masked(0x89, std::string(125, 'p'));
  std::atomic<bool> over = false;
  std::thread flood([&] {
    for (int i = 0; i < 200 && !over; ++i) client.transmit(pings);
  });
  std::this_thread::sleep_for(300ms);
  TestSocket other = opened(served);
  other.transmit(masked(0x81, "still there"));
  EXPECT_EQ(other.listen(13), "\x81\x0bstill there");
  over = true;
  client.is_closed();  // reads on, so that the flood ends
  flood.join();
}

TEST(Server, ClientsThatHaveLeftMakeRoomAtOnce) {
  Served served({.protocol = Protocol::web, .max_clients = 8});
  for (int round = 0; round < 10; ++round) {
    {
      std::vector<TestSocket> crowd;
      for (int i = 0; i < 7; ++i) {
        crowd.emplace_back(served.server());
        crowd.back().transmit("GET / HTT");  // never a whole request
      }
    }
    std::vector<TestSocket> next;
    for (int i = 0; i < 4; ++i) {
      next.emplace_back(served.server());
      next.back().transmit("nonsense\r\n\r\n");
    }
    for (TestSocket& client : next) ASSERT_EQ(client.listen(12), "HTTP/1.1 400") << round;
  }
}

TEST(Server, TwoHundredClientsGetEveryFrame) {
  Served served({.protocol = Protocol::web, .max_clients = 200});
  std::vector<TestSocket> crowd;
  for (int i = 0; i < 200; ++i) crowd.push_back(opened(served));
  TestSocket refused(served.server());
  EXPECT_TRUE(refused.is_closed());
  for (int i = 0; i < 10; ++i) {
    served.send_all(std::make_shared<const std::string>(std::string(100, static_cast<char>('0' + i))));
    std::this_thread::sleep_for(5ms);
  }
  for (TestSocket& client : crowd) {
    for (int i = 0; i < 10; ++i) ASSERT_EQ(client.listen(102).substr(2), std::string(100, static_cast<char>('0' + i)));
  }
  const auto counts = served.counts();
  EXPECT_EQ(counts.sent, 2000);
  EXPECT_EQ(counts.refused, 1);
  crowd.clear();
  EXPECT_TRUE(served.becomes([](const auto& now) { return now.now == 0; }));
}

TEST(Server, EndsAWebSocketWhoseClientIsSilent) {
  Served served({.protocol = Protocol::web, .silence = 300ms});
  TestSocket client = opened(served);
  EXPECT_EQ(client.listen(2), std::string("\x89\0", 2)) << "a ping";
  EXPECT_TRUE(client.is_closed());
}

TEST(Server, EndsAConnectionThatAsksNothing) {
  Served served({.protocol = Protocol::web, .patience = 1s});
  TestSocket silent(served.server()), half(served.server());
  half.transmit("GET / HT");
  EXPECT_TRUE(silent.is_closed());
  EXPECT_TRUE(half.is_closed());
}

}  // namespace
}  // namespace marey::net
