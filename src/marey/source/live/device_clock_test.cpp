#include "marey/source/live/device_clock.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace marey::source::live {
namespace {

struct Arrived {
  Duration device;
  double taken, arrival;  // s by the host's clock
};

/// A camera of 100 Hz whose clock goes wrong by `drift`, over a wire whose delay is 1 ms and more, ten at times.
std::vector<Arrived> camera(double drift, double duration, unsigned seed) {
  std::mt19937_64 engine(seed);
  std::exponential_distribution<double> queue(1 / 0.003);
  std::vector<Arrived> all;
  double last = 0;
  for (int i = 0; i < duration * 100; ++i) {
    const double device = 77 + i / 100.0, taken = 5 + i / 100.0 * (1 + drift);
    const double arrival = std::max(last, taken + 0.001 + queue(engine));
    last = arrival;
    all.push_back({duration_from_seconds(device), taken, arrival});
  }
  return all;
}

double worst_error(const std::vector<Arrived>& frames, double after, DeviceClock& clock) {
  double worst = 0;
  for (const Arrived& frame : frames) {
    const double reported = seconds(clock.time_of(frame.device, timestamp_from_seconds(frame.arrival)));
    EXPECT_LE(reported, frame.arrival + 1e-9);
    if (frame.taken - 5 > after) worst = std::max(worst, std::abs(reported - frame.taken - 0.001));
  }
  return worst;
}

TEST(DeviceClock, FollowsADriftingClockThroughDelays) {
  for (const double drift : {0.0, 50e-6, -50e-6, 200e-6}) {
    for (unsigned seed = 1; seed <= 5; ++seed) {
      SCOPED_TRACE(testing::Message() << "drift " << drift << ", seed " << seed);
      DeviceClock clock;
      EXPECT_LT(worst_error(camera(drift, 60, seed), 5, clock), 0.0005) << "delays are 3 ms in the mean, up to 30";
      EXPECT_NEAR(clock.drift(), drift, 10e-6);
      EXPECT_EQ(clock.steps(), 0);
    }
  }
}

/// The slow twin: of all lines through two points that no point lies below, the one with the least sum of distances.
TEST(DeviceClock, IsTheLeastSumOfDistancesOfAllLinesBelow) {
  const std::vector<Arrived> frames = camera(120e-6, 20, 9);
  DeviceClock clock({.window_s = 1e6, .bucket_s = 0.01, .settle_s = 4, .max_drift = 1});
  double reported = 0;
  for (const Arrived& frame : frames) reported = seconds(clock.time_of(frame.device, timestamp_from_seconds(frame.arrival)));
  double minimum = 1e9, best = 0;
  const std::size_t n = frames.size();
  const auto x = [&](std::size_t i) { return seconds(frames[i].device) - 77; };
  const auto y = [&](std::size_t i) { return frames[i].arrival - seconds(frames[i].device); };
  for (std::size_t i = 0; i < n; i += 1) {
    for (std::size_t k = i + 1; k < n; k += 1) {
      const double slope = (y(k) - y(i)) / (x(k) - x(i)), offset = y(i) - slope * x(i);
      double sum = 0;
      for (std::size_t j = 0; j < n && sum < minimum; ++j) {
        const double above = y(j) - offset - slope * x(j);
        sum = above < -1e-9 ? 1e9 : sum + above;
      }
      if (sum < minimum) minimum = sum, best = offset + slope * x(n - 1);
    }
  }
  EXPECT_NEAR(reported - seconds(frames.back().device), best, 1e-6);
}

TEST(DeviceClock, AClockThatIsSetBeginsAnewFit) {
  DeviceClock clock;
  const auto at = [&](double device, double arrival) {
    return seconds(clock.time_of(duration_from_seconds(device), timestamp_from_seconds(arrival)));
  };
  for (int i = 0; i < 500; ++i) EXPECT_NEAR(at(i / 100.0, 10 + i / 100.0), 10 + i / 100.0, 1e-6);
  EXPECT_NEAR(at(1.0, 15.0), 15.0, 1e-6) << "back by four seconds";
  EXPECT_EQ(clock.steps(), 1);
  EXPECT_NEAR(at(1.01, 15.01), 15.01, 1e-6);
  EXPECT_NEAR(at(100, 15.02), 15.02, 1e-6) << "ahead by a minute and a half";
  EXPECT_EQ(clock.steps(), 2);
  EXPECT_NEAR(at(100.01, 15.2), 15.03, 1e-6) << "a late frame is not a step";
  EXPECT_EQ(clock.steps(), 2);
}

}  // namespace
}  // namespace marey::source::live
