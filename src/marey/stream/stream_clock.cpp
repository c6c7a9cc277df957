#include "marey/stream/stream_clock.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace marey::stream {

std::int64_t steady_now_ns() {
  return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::int64_t wall_now_ns() {
  return std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count();
}

void CaptureClock::set(Timestamp time, std::int64_t steady_ns, double speed) {
  speed_ = speed;
  zero_ns_ = steady_ns - std::llround(static_cast<double>(time.time_since_epoch().count()) / speed);
  set_ = true;
}

std::int64_t CaptureClock::capture_ns(Timestamp time, std::int64_t arrived) {
  const std::int64_t since = std::llround(static_cast<double>(time.time_since_epoch().count()) / speed_);
  if (!set_) {
    const std::int64_t offset = arrived - since;
    if (!learned_ || offset < zero_ns_) zero_ns_ = offset;
    learned_ = true;
  }
  return std::min(arrived, zero_ns_ + since);
}

}  // namespace marey::stream
