#include "marey/calibrate/rays.h"

#include <vector>

#include <gtest/gtest.h>

#include "marey/calibrate/board/board_scene_test.h"

namespace marey::calibrate {
namespace {

using board::in_cube;
using board::Noise;

/// Lines from all round that miss `point` by some `sigma` rad.
std::vector<SightLine> lines_to(const Vector<3>& point, int count, double sigma, Noise& noise) {
  std::vector<SightLine> lines;
  for (int i = 0; i < count; ++i) {
    const Vector<3> origin = point + noise.uniform(2, 6) * in_cube(noise, 1).normalized();
    const Vector<3> ahead = (point - origin).normalized();
    lines.push_back({{origin, (ahead + sigma * in_cube(noise, 1)).normalized()}, 1e-3});
  }
  return lines;
}

double squares(std::span<const SightLine> lines, const Vector<3>& point) {
  double sum = 0;
  for (const SightLine& line : lines) sum += angle_off(line, point) * angle_off(line, point);
  return sum;
}

TEST(Rays, LinesThroughOnePointMeetThere) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    Noise noise(seed);
    const Vector<3> point = in_cube(noise, 3);
    const auto met = intersection_point(lines_to(point, 2 + static_cast<int>(seed % 5), 0, noise));
    ASSERT_TRUE(met);
    EXPECT_LT((*met - point).norm(), 1e-9);
  }
}

/// The slow twin: the sum of squared angles itself, inspected on all sides of the result.
TEST(Rays, NoPointNearbyIsNearerToAllLines) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    Noise noise(seed);
    const auto lines = lines_to(in_cube(noise, 1), 6, 2e-3, noise);
    const auto met = intersection_point(lines);
    ASSERT_TRUE(met);
    const double here = squares(lines, *met);
    for (int i = 0; i < 100; ++i) EXPECT_GT(squares(lines, *met + 1e-3 * in_cube(noise, 1).normalized()), here);
  }
}

TEST(Rays, NothingWhereThereIsNoPoint) {
  const SightLine one{{{0, 0, 0}, {0, 0, 1}}, 1e-3};
  const SightLine parallel{{{1, 0, 0}, {0, 0, 1}}, 1e-3};
  const SightLine away{{{1, 0, 0}, Vector<3>(1, 0, -1).normalized()}, 1e-3};
  EXPECT_FALSE(intersection_point({})) << "no line";
  EXPECT_FALSE(intersection_point(std::vector{one})) << "one line";
  EXPECT_FALSE(intersection_point(std::vector{one, parallel})) << "parallel";
  EXPECT_FALSE(intersection_point(std::vector{one, away})) << "behind both";
}

TEST(Rays, AFewWrongLinesDoNotMoveTheAgreedPoint) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    Noise noise(seed);
    const Vector<3> point = in_cube(noise, 1);
    auto lines = lines_to(point, 5, 0, noise);
    for (int i = 0; i < 2; ++i) lines.push_back(lines_to(point + Vector<3>(0.5, 0.4, 0.3 * i + 0.2), 1, 0, noise).front());
    const auto agreed = agreed_point(lines, 3);
    ASSERT_TRUE(agreed);
    EXPECT_LT((*agreed - point).norm(), 1e-6);
  }
}

TEST(Rays, LinesThatAllDisagreeHaveNoPoint) {
  Noise noise(3);
  std::vector<SightLine> lines;
  for (int i = 0; i < 6; ++i) lines.push_back(lines_to(3 * in_cube(noise, 1), 1, 0, noise).front());
  EXPECT_FALSE(agreed_point(lines, 3));
}

TEST(Rays, AnglesCountInSigmas) {
  const SightLine line{{{0, 0, 0}, {0, 0, 1}}, 0.01};
  EXPECT_NEAR(angle_off(line, {std::tan(0.03), 0, 1}), 3, 1e-9);
  EXPECT_NEAR(angle_off(line, {0, 0, -1}), M_PI / 0.01, 1e-6);
}

}  // namespace
}  // namespace marey::calibrate
