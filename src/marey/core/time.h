#pragma once

#include <chrono>
#include <cmath>

namespace marey {

/// Counts from the beginning of the take. It cannot be asked for the time: Marey's results never depend on when it runs.
struct TakeClock {
  using duration = std::chrono::nanoseconds;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<TakeClock>;
  static constexpr bool is_stationary = true;
};

using Duration = TakeClock::duration;
using Timestamp = TakeClock::time_point;

inline double seconds(Duration duration) {
  return std::chrono::duration<double>(duration).count();
}
inline double seconds(Timestamp time) {
  return seconds(time.time_since_epoch());
}

/// Nearest nanosecond. `value` must be finite and below 290 years.
inline Duration duration_from_seconds(double value) {
  return Duration(std::llround(value * 1e9));
}
/// Hz: what is counted at where neither a file nor its user specifies a rate.
inline constexpr double kDefaultRate = 25;

inline Timestamp timestamp_from_seconds(double value) {
  return Timestamp(duration_from_seconds(value));
}

}  // namespace marey
