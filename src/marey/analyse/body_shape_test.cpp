#include "marey/analyse/body_shape.h"

#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "marey/geometry/bspline.h"
#include "marey/geometry/ground_view.h"

namespace marey::analyse {
namespace {

/// An ellipse that leans to the right by that angle in degrees.
Outline leaning(double half_width, double half_height, double degrees, double deviation = 0.4) {
  constexpr int kPoints = 24;
  const double angle = degrees * std::numbers::pi / 180;
  Outline outline;
  for (int i = 0; i < kPoints; ++i) {
    const double t = 2 * std::numbers::pi * i / kPoints;
    const double x = half_width * std::cos(t), y = half_height * std::sin(t);
    outline.control_points.emplace_back(100 + x * std::cos(angle) - y * std::sin(angle),
                                        80 + x * std::sin(angle) + y * std::cos(angle));
  }
  outline.deviations.assign(kPoints, Vector<2>::Constant(deviation));
  return outline;
}

TEST(BodyShape, MeasuresAnEllipse) {
  const BodyShape upright = body_shape(leaning(12, 30, 0));
  EXPECT_NEAR(upright.area.value, std::numbers::pi * 12 * 30, 30);
  EXPECT_NEAR(upright.width.value, 24, 0.6);
  EXPECT_NEAR(upright.height.value, 60, 1.2);
  EXPECT_NEAR(upright.lean.value, 0, 1e-3);
  for (const double degrees : {-60.0, -20.0, 10.0, 35.0})
    EXPECT_NEAR(body_shape(leaning(12, 30, degrees)).lean.value, degrees, 0.01);
}

TEST(BodyShape, LegsThatPartOpen) {
  const auto body = [](double apart) {
    Outline outline;
    outline.order = 2;  // a polygon: hips, feet, crotch
    outline.control_points = {{90, 50},  {110, 50},         {110 + apart, 110}, {104 + apart, 110},
                              {100, 70}, {96 - apart, 110}, {90 - apart, 110}};
    outline.deviations.assign(7, Vector<2>::Constant(0.5));
    return body_shape(outline);
  };
  EXPECT_NEAR(body(0).leg_opening.value, 20, 0.01);
  EXPECT_NEAR(body(15).leg_opening.value, 50, 0.01);
  EXPECT_GT(body(15).leg_opening.deviation, 0.5);
}

TEST(BodyShape, DeviationsAreThoseOfManyTries) {
  const double deviation = 0.4;
  const Outline outline = leaning(12, 30, 15, deviation);
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, deviation);
  constexpr int kTries = 3000;
  double sums[3] = {}, squares[3] = {};
  for (int t = 0; t < kTries; ++t) {
    Outline one = outline;
    for (Vector<2>& point : one.control_points) point += Vector<2>(noise(random), noise(random));
    one.deviations.clear();
    const BodyShape shape = body_shape(one);
    const double values[3] = {shape.area.value, shape.lean.value, shape.height.value};
    for (int k = 0; k < 3; ++k) sums[k] += values[k], squares[k] += values[k] * values[k];
  }
  const BodyShape shape = body_shape(outline);
  const double expected[3] = {shape.area.deviation, shape.lean.deviation, shape.height.deviation};
  for (int k = 0; k < 3; ++k) {
    const double mean = sums[k] / kTries;
    EXPECT_NEAR(std::sqrt(squares[k] / kTries - mean * mean), expected[k], (k == 2 ? 0.35 : 0.08) * expected[k]) << k;
  }
}

TEST(BodyShape, HeightOnTheGround) {
  // A camera 6 m above the ground aimed along y, tilted down by 20 degrees.
  const double tilt = 20 * std::numbers::pi / 180;
  Matrix<3> rotation;
  rotation << 1, 0, 0, 0, -std::sin(tilt), -std::cos(tilt), 0, std::cos(tilt), -std::sin(tilt);
  const Vector<3> centre(0, -15, 6);
  const geometry::BrownLens lens{.focal = {900, 900}, .principal = {480, 270}};
  const Camera camera(lens, {rotation, -(rotation * centre)}, {960, 540});
  const auto foot = camera.project({1, 0, 0}), head = camera.project({1, 0, 1.8});
  ASSERT_TRUE(foot && head);
  const double half = (foot->y() - head->y()) / 2;
  Outline outline;
  outline.order = 2;
  outline.control_points = {
      {foot->x(), head->y()}, {foot->x() + 8, head->y() + half}, {foot->x(), foot->y()}, {foot->x() - 8, head->y() + half}};
  outline.deviations.assign(4, Vector<2>::Constant(0.5));
  const auto body = body_on_ground(outline, GroundView(camera));
  ASSERT_TRUE(body);
  EXPECT_NEAR(body->height.value, 1.8, 1e-3);
  EXPECT_NEAR(body->scale.value, 1.8 / (2 * half), 1e-4);
  EXPECT_GT(body->height.deviation, 0.5 * body->scale.value);
  EXPECT_LT(body->height.deviation, 2 * body->scale.value);
}

TEST(BodyShape, OnlyWhatIsSeenIsMeasured) {
  Outline outline = leaning(12, 30, 0);
  EXPECT_TRUE(is_measurable(outline));
  outline.hidden = {0, 1, 2, 3, 4, 5, 6, 7};
  EXPECT_FALSE(is_measurable(outline));
  outline.hidden.clear();
  outline.state = Outline::State::held;
  EXPECT_FALSE(is_measurable(outline));
}

}  // namespace
}  // namespace marey::analyse
