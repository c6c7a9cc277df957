// A camera node over loopback: from when a frame is handed over to when the host has it, and what its time is off, beside ZeroMQ
// alone with the same bytes. The two clocks begin at different times; how far apart they are is known here, and not to them.
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
#include <zmq.hpp>

#include "marey/source/live/live_camera.h"
#include "marey/source/live/node.h"

namespace {

using namespace marey;
using marey::source::steady_time;
using namespace marey::source::live;
using Steady = std::chrono::steady_clock;

constexpr int kPort = 27'780;

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return NAN;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

double seconds_since(Steady::time_point begin) {
  return std::chrono::duration<double>(Steady::now() - begin).count();
}

std::string frame_of(std::int64_t sequence, Timestamp taken, int markers) {
  NodeFrame frame{.session = 1, .sequence = sequence, .taken = taken, .size = {640, 480}};
  frame.detections.emplace(static_cast<std::size_t>(markers));
  return message_of(frame);
}

void print(const char* name, const std::vector<double>& took_s) {
  fmt::print("{:<14} {:>8} frames  p50 {:7.3f} ms  p99 {:7.3f} ms\n", name, took_s.size(), 1e3 * quantile(took_s, 0.5),
             1e3 * quantile(took_s, 0.99));
}

/// A loop of `frames` at `rate_hz`.
template <typename Send>
void send_all(int frames, double rate_hz, Send send) {
  const auto begin = Steady::now();
  for (int i = 0; i < frames; ++i) {
    std::this_thread::sleep_until(begin + std::chrono::duration_cast<Steady::duration>(std::chrono::duration<double>(i / rate_hz)));
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
  fmt::print("{:<14} {:>8} lost  its time is off by {:.3f} ms (median), {:.3f} ms (most)\n", "", camera->report().lost,
             1e3 * quantile(off_s, 0.5), 1e3 * quantile(off_s, 1));
}

void measure_zeromq(int frames, double rate_hz, int markers) {
  zmq::context_t context;
  zmq::socket_t out(context, zmq::socket_type::pub), in(context, zmq::socket_type::sub);
  out.bind("tcp://127.0.0.1:*");
  in.set(zmq::sockopt::subscribe, "");
  in.connect(out.get(zmq::sockopt::last_endpoint));
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  const auto begin = Steady::now();
  std::vector<double> took_s;
  std::jthread host([&] {
    zmq::message_t message;
    for (int i = 0; i < frames; ++i) {
      if (!in.recv(message)) break;
      took_s.push_back(seconds_since(begin) - seconds(read_node_frame({message.data<char>(), message.size()}, "zeromq").taken));
    }
  });
  send_all(frames, rate_hz,
           [&](int i) { out.send(zmq::buffer(frame_of(i, timestamp_from_seconds(seconds_since(begin)), markers))); });
  host.join();
  print("ZeroMQ alone", took_s);
}

}  // namespace

int main(int argc, char** argv) {
  const double duration_s = argc > 1 ? std::atof(argv[1]) : 10, rate_hz = argc > 2 ? std::atof(argv[2]) : 100;
  const int markers = argc > 3 ? std::atoi(argv[3]) : 40, frames = static_cast<int>(duration_s * rate_hz);
  fmt::print("{} markers at {:g} Hz for {:g} s, {} bytes a frame\n", markers, rate_hz, duration_s, frame_of(0, {}, markers).size());
  measure_node(frames, rate_hz, markers);
  measure_zeromq(frames, rate_hz, markers);
}
