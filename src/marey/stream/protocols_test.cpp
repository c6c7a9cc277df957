// Over real sockets of this host: slow clients, hostile ones, many at once, a port that is taken.
#include "marey/stream/protocols.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <fstream>
#include <sstream>
#include <thread>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "marey/stream/bytes.h"
#include "marey/stream/json_text.h"
#include "marey/stream/streams.h"

#include "support/data.h"
#include "support/moving_bodies.h"

namespace marey::stream {
namespace {

using namespace std::chrono_literals;

/// A client that waits for two seconds at most.
class TestClient {
 public:
  explicit TestClient(const std::string& where, int receive_buffer = 0)
      : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(std::stoi(where.substr(where.rfind(':') + 1))));
    to.sin_addr.s_addr = htonl(net::kLoopback);
    const timeval patience{.tv_sec = 2, .tv_usec = 0};
    setsockopt(socket_.get(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    if (receive_buffer > 0) setsockopt(socket_.get(), SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    connected_ = connect(socket_.get(), reinterpret_cast<sockaddr*>(&to), sizeof to) == 0;
  }
  bool connected() const { return connected_; }
  void announce(std::string_view bytes) { send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL); }
  /// What comes next; empty if the server has closed, or says nothing.
  std::string listen() {
    std::array<char, 65536> bytes;
    const ssize_t got = recv(socket_.get(), bytes.data(), bytes.size(), 0);
    return got > 0 ? std::string(bytes.data(), static_cast<std::size_t>(got)) : std::string();
  }
  /// Until that is there.
  std::string receive_until(std::string_view end) {
    std::string received;
    while (received.find(end) == std::string::npos) {
      const std::string more = listen();
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

 private:
  net::Descriptor socket_;
  bool connected_ = false;
};

std::unique_ptr<ProtocolSink> begun(const std::string& target, const StreamOptions& options = {}) {
  auto protocol = open_protocol(parse_target(target), options);
  protocol->begin(test::header_of_moving_bodies());
  return protocol;
}

/// Frames at 500 a second from the `first` on, until `done`.
template <typename Done>
bool write_until(ProtocolSink& protocol, int& k, const Done& done, int maximum = 1500) {
  for (const int last = k + maximum; k < last; ++k) {
    if (done()) return true;
    protocol.write(test::moving_bodies(k));
    std::this_thread::sleep_for(2ms);
  }
  return done();
}

std::string refusal_of(const std::string& text) {
  try {
    parse_target(text);
  } catch (const WrongTarget& error) {
    return error.what();
  }
  return "taken";
}

TEST(Wires, ATargetIsAWireAndMaybeAHostAndAPort) {
  EXPECT_EQ(parse_target("qtm").host, "127.0.0.1");
  EXPECT_EQ(parse_target("qtm").port, 22'223);
  EXPECT_EQ(parse_target("vmc:192.168.0.9").host, "192.168.0.9");
  EXPECT_EQ(parse_target("vmc:192.168.0.9").port, 39'539);
  EXPECT_EQ(parse_target("json:0.0.0.0:7000").port, 7000);
  EXPECT_EQ(parse_target("json::7000").host, "127.0.0.1");
  EXPECT_EQ(parse_target("json:localhost:0").port, 0);
  EXPECT_EQ(refusal_of("word"), "\"word\" is not a wire; there are qtm, natnet, natnet-unicast, vmc, osc, lsl, foxglove, json");
  for (const char* wrong : {"", "qtm:", "qtm:a:b", "qtm:a:70000", "qtm:a:-1", "qtm:a:1:2", "qtm:a/b", "vmc:a:0", "qtm:[::1]"})
    EXPECT_NE(refusal_of(wrong), "taken") << wrong;
}

TEST(Wires, EveryRowIsWholeAndTheTableStandsInTheDocuments) {
  for (const StreamProtocol& protocol : protocols()) {
    EXPECT_FALSE(protocol.name.empty() || protocol.title.empty() || protocol.detail.empty()) << protocol.name;
    EXPECT_GT(protocol.port, 0);
    EXPECT_NE(protocol.open, nullptr);
  }
  std::ifstream file(test::of_project("docs/streams.md"));
  std::stringstream text;
  text << file.rdbuf();
  EXPECT_NE(text.str().find(protocol_table()), std::string::npos) << "docs/streams.md should hold this table:\n"
                                                                  << protocol_table();
}

TEST(Wires, APortThatIsTakenIsToldInASentence) {
  const auto first = open_protocol(parse_target("json::0"));
  const std::string port = first->where().substr(first->where().rfind(':') + 1);
  try {
    open_protocol(parse_target("qtm::" + port));
    FAIL() << "two have the port";
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()),
              "qtm: port " + port + " of 127.0.0.1 is in use by another program; stop that, or name another port");
  }
  EXPECT_THROW(open_protocol(parse_target("json:203.0.113.7:0")), Error);
}

TEST(Wires, MetresAreAskedForWhereAWireCarriesMetres) {
  RecordingHeader header;
  header.frame.kind = FrameOfReference::Kind::image;
  header.rate_hz = 25;
  EXPECT_THROW(open_protocol(parse_target("qtm::0"))->begin(header), Error);
  EXPECT_NO_THROW(open_protocol(parse_target("json::0"))->begin(header));
}

TEST(Wires, JsonSaysItsHeaderAndThenFrames) {
  const auto protocol = begun("json::0");
  TestClient client(protocol->where());
  int k = 0;
  ASSERT_TRUE(write_until(*protocol, k, [&] { return protocol->report().sent > 3; }));
  protocol->finish();
  const std::string received = client.receive_until("\"type\":\"frame\"");
  EXPECT_TRUE(received.starts_with(
      R"({"type":"header","version":1,"name":"bodies","frame":"space","unit":"m","rate_hz":100,"up":"z","labels":["LASI","RASI"])"))
      << received;
  EXPECT_NE(received.find(R"("label":"racket")"), std::string::npos);
}

TEST(Wires, JsonGoesThroughAWebSocketAsWell) {
  const auto protocol = begun("json::0");
  TestClient client(protocol->where());
  client.announce(
      "GET / HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n");
  const std::string received = client.receive_until("\"header\"");
  EXPECT_TRUE(received.starts_with("HTTP/1.1 101 Switching Protocols\r\n")) << received;
  EXPECT_NE(received.find("\r\n\r\n\x81"), std::string::npos);
  TestClient foreign(protocol->where());
  foreign.announce(
      "GET / HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\nOrigin: https://evil.example\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n");
  EXPECT_TRUE(foreign.listen().starts_with("HTTP/1.1 403 Forbidden"));
  EXPECT_TRUE(foreign.is_closed());
}

TEST(Wires, AClientThatReadsNothingLosesItsOwnFramesAlone) {
  const auto protocol = begun("json::0");
  TestClient slow(protocol->where(), 4096), quick(protocol->where());
  std::atomic<bool> over = false;
  std::atomic<int> lines = 0;
  std::thread reader([&] {
    while (!over) {
      const std::string received = quick.listen();
      lines += static_cast<int>(std::count(received.begin(), received.end(), '\n'));
    }
  });
  int k = 0;
  ASSERT_TRUE(write_until(*protocol, k, [&] { return protocol->report().dropped > 200; }, 5000));
  const StreamReport report = protocol->report();
  protocol->finish();
  over = true;
  reader.join();
  EXPECT_EQ(report.clients, 2);
  EXPECT_GE(lines, report.sent / 2 - 20);         // the quick one had nearly all
  EXPECT_LT(report.sending.quantile(0.5), 0.01);  // waiting for the slow one would hold up every frame, a busy machine some
}

TEST(Wires, GarbageGigabytesAndHalfPacketsEndTheirOwnConnectionAlone) {
  const auto protocol = begun("qtm::0");
  TestClient good(protocol->where());
  EXPECT_EQ(good.listen().substr(8), std::string("QTM RT Interface connected\0", 27));
  TestClient huge(protocol->where());
  huge.announce(std::string("\xff\xff\xff\xff\x01\0\0\0", 8));
  EXPECT_TRUE(huge.is_closed());
  TestClient garbage(protocol->where());
  garbage.announce(std::string(5000, 'x'));
  EXPECT_TRUE(garbage.is_closed());
  TestClient half(protocol->where());
  half.announce(std::string("\x20\0\0\0\x01\0", 6));
  good.announce(std::string("\x16\0\0\0\x01\0\0\0version 1.19\0\0", 22));
  EXPECT_EQ(good.listen().substr(8), std::string("Version set to 1.19\0", 20));
  EXPECT_EQ(protocol->report().disconnected_clients, 2);
  EXPECT_FALSE(protocol->report().notes.empty());
}

TEST(Wires, DisconnectsClientThatReadsNothing) {
  const auto protocol = begun("qtm::0");
  TestClient client(protocol->where(), 4096);
  std::string questions;
  for (int i = 0; i < 500; ++i) questions += std::string("\x15\0\0\0\x01\0\0\0getparameters all", 25).replace(0, 1, "\x19");
  for (int i = 0; i < 200 && protocol->report().now > 0; ++i) client.announce(questions);
  for (int i = 0; i < 100 && protocol->report().now > 0; ++i) std::this_thread::sleep_for(20ms);
  EXPECT_EQ(protocol->report().now, 0);
}

TEST(Wires, AThousandConnectionsAreTakenToTheLimitAndTurnedAway) {
  const auto protocol = begun("qtm::0");
  TestClient first(protocol->where());
  EXPECT_FALSE(first.listen().empty());
  std::vector<std::unique_ptr<TestClient>> crowd;
  for (int i = 0; i < 1000; ++i) {
    crowd.push_back(std::make_unique<TestClient>(protocol->where()));
    if (crowd.size() > 100) crowd.erase(crowd.begin());
  }
  for (int i = 0; i < 100 && protocol->report().refused + protocol->report().clients < 1001; ++i) std::this_thread::sleep_for(20ms);
  first.announce(std::string("\x10\0\0\0\x01\0\0\0getstate", 16));
  EXPECT_EQ(first.listen().size(), 9u);
  EXPECT_GT(protocol->report().refused, 0);
  EXPECT_LE(protocol->report().now, 10);
}

TEST(Wires, TheEndIsSaid) {
  const auto protocol = begun("qtm::0");
  TestClient client(protocol->where());
  client.listen();
  client.announce(std::string("\x22\0\0\0\x01\0\0\0streamframes allframes 3d", 33).replace(0, 1, "\x21"));
  int k = 0;
  EXPECT_EQ(client.listen(), std::string("\x08\0\0\0\x04\0\0\0", 8));  // nothing yet
  ASSERT_TRUE(write_until(*protocol, k, [&] { return protocol->report().sent >= 2; }));
  protocol->finish();
  std::string received;
  for (std::string more = client.listen(); !more.empty(); more = client.listen()) received += more;
  EXPECT_TRUE(received.ends_with(std::string("\x08\0\0\0\x04\0\0\0\x09\0\0\0\x06\0\0\0\x0c", 17)));
}

TEST(Wires, StreamsLendTheirWiresAndReport) {
  Streams streams({"json::0", "osc", "vmc"});
  auto sinks = streams.sinks();
  for (const auto& sink : sinks) sink->begin(test::header_of_moving_bodies());
  for (const auto& sink : sinks) sink->write(test::moving_bodies(0));
  for (const auto& sink : sinks) sink->finish();
  sinks.clear();
  const auto reports = streams.reports();
  ASSERT_EQ(reports.size(), 3u);
  EXPECT_EQ(reports[1].sent, 1);
  EXPECT_TRUE(to_string(reports[1]).starts_with("osc to 127.0.0.1:9000: 1 frames sent, 0 dropped"));
}

TEST(StreamClock, CaptureIsWhatIsSetOrTheLeastDelaySeen) {
  CaptureClock reported;
  reported.set(Timestamp(std::chrono::seconds(10)), 1'000'000'000, 2);
  EXPECT_EQ(reported.capture_ns(Timestamp(std::chrono::seconds(12)), 9'000'000'000), 2'000'000'000);
  EXPECT_EQ(reported.capture_ns(Timestamp(std::chrono::seconds(12)), 1'500'000'000), 1'500'000'000);
  CaptureClock learned;
  EXPECT_EQ(learned.capture_ns(Timestamp(std::chrono::seconds(0)), 100), 100);
  EXPECT_EQ(learned.capture_ns(Timestamp(std::chrono::nanoseconds(1000)), 1300), 1100);
  EXPECT_EQ(learned.capture_ns(Timestamp(std::chrono::nanoseconds(2000)), 2050), 2050);
  EXPECT_EQ(learned.capture_ns(Timestamp(std::chrono::nanoseconds(3000)), 3200), 3050);
}

TEST(ChannelLayout, ALabelKeepsItsPlaceWhoeverBearsIt) {
  ChannelLayout channel_layout;
  channel_layout.begin({});
  EXPECT_TRUE(channel_layout.add(
      std::vector<TrackName>{{.id = TrackId(1), .label = "A", .team = {}}, {.id = TrackId(2), .label = "9", .team = "Home"}}));
  EXPECT_FALSE(channel_layout.add(std::vector<TrackName>{{.id = TrackId(7), .label = "A", .team = {}}}));
  EXPECT_EQ(channel_layout.labels(), (std::vector<std::string>{"A", "Home 9"}));
  Instant instant;
  for (const int track : {2, 7, 9}) instant.samples.push_back(test::point_at(track, {0, 0, 0}));
  ChannelLayout::Scene scene;
  channel_layout.location(instant, scene);
  EXPECT_EQ(scene.labelled[0], &instant.samples[1]);
  EXPECT_EQ(scene.labelled[1], &instant.samples[0]);
  EXPECT_EQ(scene.others.size(), 1u);
}

}  // namespace
}  // namespace marey::stream
