// A camera node over loopback: from when a frame is passed  to when the host has it, and what its time is off, beside a
// WebSocket alone with the same bytes. The two clocks begin at different times; how far apart they are is known here, and not to
// them.
//
// Usage: node_latency [SECONDS [HZ [MARKERS]]]
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <fmt/core.h>

#include "marey/net/client.h"
#include "marey/net/server.h"
#include "marey/source/live/live_camera.h"
#include "marey/source/live/node.h"

namespace {

using namespace marey;
using marey::source::steady_time;
using namespace marey::source::live;
using Stabilise = std::chrono::steady_clock;

constexpr int kPort = 27'780;

double quantile(std::vector<double> values, double fraction) {
  if (values.empty()) return NAN;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(fraction * static_cast<double>(values.size() - 1))];
}

double seconds_since(Stabilise::time_point begin) {
  return std::chrono::duration<double>(Stabilise::now() - begin).count();
}

std::string frame_of(std::int64_t sequence, Timestamp taken, int markers) {
  NodeFrame frame{.session = 1, .sequence = sequence, .taken = taken, .size = {640, 480}};
  frame.detections.emplace(static_cast<std::size_t>(markers));
  return message_of(frame);
}

void print(const char* name, const std::vector<double>& took_s) {
  fmt::print("{:<15} {:>8} frames  p50 {:7.3f} ms  p99 {:7.3f} ms\n", name, took_s.size(), 1e3 * quantile(took_s, 0.5),
             1e3 * quantile(took_s, 0.99));
}

/// A loop of `frames` at `rate_hz`.
template <typename Send>
void send_all(int frames, double rate_hz, Send send) {
  const auto begin = Stabilise::now();
  for (int i = 0; i < frames; ++i) {
    std::this_thread::sleep_until(begin +
                                  std::chrono::duration_cast<Stabilise::duration>(std::chrono::duration<double>(i / rate_hz)));
    send(i);
  }
}

void measure_node(int frames, double rate_hz, int markers) {
  const auto there = steady_time();
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  const auto here = steady_time();
  const Duration apart = there->now() - here->now();
  NodeServer server(
      "127.0.0.1", kPort,
      [&](const std::string&) {
        return NodeAnswer{.session = 1, .now = there->now(), .known = true, .size = {640, 480}, .rate_hz = rate_hz, .cameras = {}};
      },
      [] { return std::string(); });
  const auto camera =
      keep_connected("node", connect_node({.host = "127.0.0.1", .port = kPort, .camera = "left"}), here, {.keep = 1 << 20});
  while (!camera->connected()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  std::mutex mutex;
  std::vector<double> taken_s, took_s, off_s;
  std::atomic<bool> done = false;
  std::jthread host([&] {
    std::size_t next = 0;
    while (!done) {
      here->wait();
      for (const CameraFrame& frame : camera->arrived()) {
        const std::lock_guard lock(mutex);
        took_s.push_back(seconds(here->now()) - taken_s[next]);
        off_s.push_back(std::abs(seconds(frame.frame.time) - taken_s[next++]));
      }
    }
  });
  send_all(frames, rate_hz, [&](int i) {
    const Timestamp taken = there->now();
    {
      const std::lock_guard lock(mutex);
      taken_s.push_back(seconds(taken - apart));
    }
    server.send("left", frame_of(i, taken, markers));
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  done = true;
  host.join();
  print("marey node", took_s);
  fmt::print("{:<15} {:>8} lost  its time is off by {:.3f} ms (median), {:.3f} ms (most)\n", "", camera->health().lost,
             1e3 * quantile(off_s, 0.5), 1e3 * quantile(off_s, 1));
}

class Listener : public net::Session {
 public:
  net::HttpAnswer requested(const net::HttpRequest&) override { return {.upgrade = true}; }
};

void measure_websocket(int frames, double rate_hz, int markers) {
  net::Loop loop;
  net::Server server(loop, net::Address{.host = net::kLoopback, .port = 0}, "bench", {.protocol = net::Protocol::web},
                     [](const net::Address&) { return std::make_unique<Listener>(); });
  loop.start();
  net::WebSocketClient in("127.0.0.1", server.address().port, {}, {});
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  const auto begin = Stabilise::now();
  std::vector<double> took_s;
  std::jthread host([&] {
    for (int i = 0; i < frames; ++i) {
      const auto message = in.receive(std::chrono::seconds(10));
      if (!message) break;
      took_s.push_back(seconds_since(begin) - seconds(read_node_frame(*message, "websocket").taken));
    }
  });
  send_all(frames, rate_hz, [&](int i) {
    const auto body = std::make_shared<const std::string>(frame_of(i, timestamp_from_seconds(seconds_since(begin)), markers));
    const std::scoped_lock lock(loop.mutex());
    server.each([&](net::Session&, net::Outbox& out) { out.frame({.body = body}); });
  });
  host.join();
  loop.stop();
  print("WebSocket alone", took_s);
}

}  // namespace

int main(int argc, char** argv) {
  const double duration_s = argc > 1 ? std::atof(argv[1]) : 10, rate_hz = argc > 2 ? std::atof(argv[2]) : 100;
  const int markers = argc > 3 ? std::atoi(argv[3]) : 40, frames = static_cast<int>(duration_s * rate_hz);
  fmt::print("{} markers at {:g} Hz for {:g} s, {} bytes a frame\n", markers, rate_hz, duration_s, frame_of(0, {}, markers).size());
  measure_node(frames, rate_hz, markers);
  measure_websocket(frames, rate_hz, markers);
}
