#include "marey/calibrate/pitch/ground_paths.h"

#include <gtest/gtest.h>

#include "marey/calibrate/board/board_scene_test.h"

namespace marey::calibrate::pitch {
namespace {

using board::Noise;

/// A person who runs along a parabola: a smoothing by parabolas has no error.
Vector<2> runner(double t) {
  return {3 + 4 * t - 0.5 * t * t, 10 - 2 * t + 0.3 * t * t};
}

GroundPath path_of(double begin, double end, double rate_hz, double sigma, Noise& noise) {
  GroundPath path;
  for (int i = 0; begin + i / rate_hz < end; ++i) {
    const double t = begin + i / rate_hz;
    const Matrix<2> covariance = Matrix<2>::Identity() * std::max(1e-4, sigma * sigma);
    path.samples.push_back({t, runner(t) + Vector<2>(noise.gaussian(sigma), noise.gaussian(sigma)), covariance});
  }
  return path;
}

TEST(SmoothPath, FollowsAParabolaExactlyAndWithoutLag) {
  Noise noise(1);
  for (const double rate : {10.0, 25.0, 50.0}) {
    const SmoothPath smooth(path_of(2, 8, rate, 0, noise));
    EXPECT_NEAR(smooth.begin_s(), 2, 1e-12);
    for (double t = 2.5; t < 7; t += 0.037) {
      const auto state = smooth.at(t);
      ASSERT_TRUE(state) << t;
      EXPECT_LT((state->location - runner(t)).norm(), 1e-6) << t;
      EXPECT_LT((state->velocity - Vector<2>(4 - t, -2 + 0.6 * t)).norm(), 1e-6) << t;
    }
  }
}

TEST(SmoothPath, NoiseIsAveragedAway) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    Noise noise(seed);
    const SmoothPath smooth(path_of(0, 30, 25, 0.2, noise));
    double square = 0;
    int count = 0;
    for (double t = 1; t < 29; t += 0.05, ++count) square += (smooth.at(t)->location - runner(t)).squaredNorm() / 2;
    EXPECT_LT(std::sqrt(square / count), 0.1) << "of 0.2 m in a frame";
    EXPECT_NEAR(smooth.at(10)->noise(0, 0), 0.04 / 2, 1e-9) << "worth two independent samples";
  }
}

TEST(SmoothPath, NothingOutsideInAGapOrOfTooLittle) {
  Noise noise(3);
  GroundPath path = path_of(0, 10, 25, 0, noise);
  std::erase_if(path.samples, [](const auto& sample) { return sample.time_s > 4 && sample.time_s < 6; });
  const SmoothPath smooth(path);
  EXPECT_FALSE(smooth.at(-1));
  EXPECT_FALSE(smooth.at(0)) << "nothing before it";
  EXPECT_FALSE(smooth.at(5));
  EXPECT_FALSE(smooth.at(11));
  EXPECT_TRUE(smooth.at(3));
  EXPECT_TRUE(smooth.at(7));
  path.samples.resize(3);
  EXPECT_FALSE(SmoothPath(path).at(0.05));
  EXPECT_FALSE(SmoothPath({}).at(0));
}

}  // namespace
}  // namespace marey::calibrate::pitch
