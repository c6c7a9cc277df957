#include "marey/track/ground/motion_statistics.h"

#include <cmath>

#include <gtest/gtest.h>

#include "marey/track/ground/ground_scene_test.h"

namespace marey::track::ground {
namespace {

/// Twenty people whose velocity strays by `acceleration` each √second, seen `rate` times a second with `noise` m, of which 0.1 m is
/// known.
std::vector<offline::GroundTracklet> walks(double acceleration, double rate, double noise, int instants) {
  ground_scene::Random random(7);
  std::vector<offline::GroundTracklet> tracklets;
  for (int i = 0; i < 20; ++i) {
    offline::GroundTracklet& one = tracklets.emplace_back();
    one.runs = {{TrackId{i + 1}, 0}};
    one.confirmed = true;
    Vector<2> location = random.gaussian(10), velocity = random.gaussian(1);
    for (int k = 0; k < instants; ++k) {
      velocity += random.gaussian(acceleration / std::sqrt(rate));
      location += velocity / rate;
      const Vector<2> detected = location + random.gaussian(noise);
      offline::GroundSample& sample = one.samples.emplace_back();
      sample.instant = k;
      sample.location = {static_cast<float>(detected.x()), static_cast<float>(detected.y())};
      sample.covariance = {0.01F, 0, 0.01F};
    }
  }
  return tracklets;
}

std::vector<Timestamp> times_of(int instants, double rate) {
  std::vector<Timestamp> times;
  for (int k = 0; k < instants; ++k) times.push_back(timestamp_from_seconds(k / rate));
  return times;
}

TEST(MotionStatistics, HasteIsMeasuredWhateverTheNoise) {
  for (const double noise : {0.1, 0.2}) {
    for (const double acceleration : {0.4, 1.0, 2.6}) {
      const auto walk = learn_walk(walks(acceleration, 2, noise, 60), times_of(60, 2));
      ASSERT_TRUE(walk);
      EXPECT_GT(walk->acceleration, acceleration / 1.5) << noise;
      EXPECT_LT(walk->acceleration, acceleration * 1.5) << noise;
    }
  }
}

TEST(MotionStatistics, FewPlacesTellNothing) {
  EXPECT_FALSE(learn_walk(walks(1, 2, 0.1, 4), times_of(4, 2)));
  EXPECT_FALSE(learn_walk({}, {}));
}

}  // namespace
}  // namespace marey::track::ground
