// How long an instant of 40 markers takes from the wire's hands to the system, and to a client of this host: at 100 Hz, with and
// without a second client that reads nothing. Prints a table. Usage: stream_latency [SECONDS]
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include "marey/stream/protocols.h"

namespace {

using namespace marey;

constexpr int kMarkers = 40;
constexpr auto kPeriod = std::chrono::milliseconds(10);

Instant time_step(int k) {
  Instant instant;
  instant.index = k;
  instant.time = Timestamp(k * kPeriod);
  for (int m = 1; m <= kMarkers; ++m) {
    if (k == 0) instant.named.push_back({.id = TrackId(m), .label = fmt::format("M{}", m), .team = {}});
    Sample& sample = instant.samples.emplace_back();
    sample.track = TrackId(m);
    sample.position = {0.001 * k, 0.05 * m, 1};
  }
  return instant;
}

constexpr std::string_view kUpgrade =
    "GET / HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
    "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Protocol: foxglove.sdk.v1\r\n\r\n";

/// What makes a client of that wire be sent frames.
std::string hello(const std::string& protocol) {
  if (protocol == "qtm") return std::string("\x22\0\0\0\x01\0\0\0streamframes allframes 3d\0", 34);
  if (protocol == "foxglove") {  // masked with zeros
    const std::string text = R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":1}]})";
    return std::string("\x81") + static_cast<char>(0x80 | text.size()) + std::string(4, '\0') + text;
  }
  return "hello\n";
}

net::Descriptor connected(const std::string& where, const std::string& protocol) {
  net::Descriptor made(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(std::atoi(where.substr(where.rfind(':') + 1).c_str())));
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (connect(made.get(), reinterpret_cast<sockaddr*>(&to), sizeof to) != 0) std::abort();
  if (protocol == "foxglove") {
    std::array<char, 65536> opened;
    send(made.get(), kUpgrade.data(), kUpgrade.size(), MSG_NOSIGNAL);
    if (recv(made.get(), opened.data(), opened.size(), 0) <= 0) std::abort();
  }
  const std::string first = hello(protocol);
  send(made.get(), first.data(), first.size(), MSG_NOSIGNAL);
  return made;
}

double quantile(std::vector<double> values, double fraction) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, static_cast<std::size_t>(fraction * static_cast<double>(values.size())))];
}

void measure(const std::string& protocol, bool with_stalled, int frames) {
  const auto sink = stream::open_protocol(stream::parse_target(protocol + ":127.0.0.1:0"));
  RecordingHeader header;
  header.rate_hz = 100;
  sink->begin(header);
  const auto client = connected(sink->where(), protocol);
  const auto stalled = with_stalled ? connected(sink->where(), protocol) : net::Descriptor();
  std::atomic<std::int64_t> given = 0;
  std::vector<double> ms;
  std::thread reader([&] {
    std::array<char, 65536> bytes;
    std::int64_t before = 0;
    while (recv(client.get(), bytes.data(), bytes.size(), 0) > 0) {
      const std::int64_t now = stream::steady_now_ns(), at = given;
      if (at != 0 && at != before) ms.push_back(1e-6 * static_cast<double>(now - at));
      before = at;
    }
  });
  auto due = std::chrono::steady_clock::now() + std::chrono::milliseconds(300);
  for (int k = 0; k < frames; ++k, due += kPeriod) {
    const Instant instant = time_step(k);
    std::this_thread::sleep_until(due);
    given = stream::steady_now_ns();
    sink->write(instant);
  }
  const stream::StreamReport report = sink->report();
  sink->finish();
  shutdown(client.get(), SHUT_RDWR);
  reader.join();
  std::printf("%-9s %-8s %8.3f %8.3f   %8.3f %8.3f   %6zu of %d, %lld frames dropped\n", protocol.c_str(),
              with_stalled ? "yes" : "no", 1e3 * report.sending.quantile(0.5), 1e3 * report.sending.quantile(0.99),
              quantile(ms, 0.5), quantile(ms, 0.99), ms.size(), frames, static_cast<long long>(report.dropped));
}

}  // namespace

int main(int argc, char** argv) {
  const int frames = static_cast<int>(100 * (argc > 1 ? std::strtod(argv[1], nullptr) : 10));
  std::printf("%-9s %-8s %17s   %17s   %s\n", "", "stalled", "to the system, ms", "to a client, ms", "");
  std::printf("%-9s %-8s %8s %8s   %8s %8s   %s\n", "wire", "beside", "p50", "p99", "p50", "p99", "samples");
  for (const char* protocol : {"qtm", "json", "foxglove"}) {
    for (const bool with_stalled : {false, true}) measure(protocol, with_stalled, frames);
  }
  return 0;
}
