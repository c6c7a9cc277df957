#include "marey/geometry/bspline.h"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace marey::geometry {
namespace {

class Dice {
 public:
  explicit Dice(unsigned seed) : engine_(seed) {}
  double uniform(double low, double high) { return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1.0p-53); }

 private:
  std::mt19937_64 engine_;
};

/// Control points about a circle of 20 px, each up to 6 px off: a curve that rarely crosses itself.
ClosedSpline random_spline(int order, int count, Dice& dice) {
  std::vector<Vector<2>> points;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count;
    points.emplace_back(100 + 20 * std::cos(angle) + dice.uniform(-6, 6), 50 + 20 * std::sin(angle) + dice.uniform(-6, 6));
  }
  return {order, std::move(points)};
}

/// The definition: B is the box convolved with itself, here by the textbook's recursion from x alone.
double cardinal(int order, double x) {
  if (order == 1) return x >= 0 && x < 1 ? 1 : 0;
  return (x * cardinal(order - 1, x) + (order - x) * cardinal(order - 1, x - 1)) / (order - 1);
}

Vector<2> slow_at(const ClosedSpline& spline, double u) {
  Vector<2> sum = Vector<2>::Zero();
  for (int i = 0; i < spline.count(); ++i) {
    for (int round = -3; round <= 3; ++round) {
      sum += cardinal(spline.order(), u - i + round * spline.count() + spline.order() / 2.0) * spline.control_points()[i];
    }
  }
  return sum;
}

class ClosedSplineOf : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Orders, ClosedSplineOf, testing::Values(2, 3, 4, 5, 8));

TEST_P(ClosedSplineOf, PointsAreThoseOfTheDefinition) {
  Dice dice(1);
  for (const int count : {std::max(GetParam(), 3), 9, 24}) {
    const ClosedSpline spline = random_spline(GetParam(), count, dice);
    for (int i = 0; i < 200; ++i) {
      const double u = dice.uniform(-2 * count, 3 * count);
      EXPECT_NEAR((spline.at(u) - slow_at(spline, std::fmod(u + 2 * count, count))).norm(), 0, 1e-11) << count << " " << u;
      EXPECT_NEAR((spline.at(u) - spline.at(u + count)).norm(), 0, 1e-11) << "closed";
      if (GetParam() == 2) continue;  // its derivative jumps
      const double h = 1e-5;
      const Vector<2> slope = (spline.at(u + h) - spline.at(u - h)) / (2 * h);
      EXPECT_NEAR((spline.derivative(u) - slope).norm(), 0, 2e-4);
      const auto normal = spline.normal(u);
      ASSERT_TRUE(normal.has_value());
      EXPECT_NEAR(normal->dot(spline.derivative(u)), 0, 1e-9);
      EXPECT_NEAR(normal->norm(), 1, 1e-12);
    }
  }
}

TEST_P(ClosedSplineOf, AreaCentreAndLengthAreThoseOfAFinePolygon) {
  Dice dice(2);
  for (int repeat = 0; repeat < 20; ++repeat) {
    const ClosedSpline spline = random_spline(GetParam(), 8 + repeat, dice);
    const auto polygon = spline.polygon(1000);
    EXPECT_NEAR(spline.area(), polygon_area(polygon), 1e-3) << repeat;
    EXPECT_GT(spline.area(), 0) << "clockwise on the screen";
    EXPECT_NEAR((spline.centroid() - *polygon_centroid(polygon)).norm(), 0, 1e-4) << repeat;
    double length = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) length += (polygon[i] - polygon[(i + 1) % polygon.size()]).norm();
    EXPECT_NEAR(spline.length(), length, 1e-3 * length);
  }
}

TEST_P(ClosedSplineOf, NormalsPointOutOfAClockwiseCurve) {
  std::vector<Vector<2>> circle;
  for (int i = 0; i < 16; ++i) circle.emplace_back(9 * std::cos(i * std::numbers::pi / 8), 9 * std::sin(i * std::numbers::pi / 8));
  const ClosedSpline spline(GetParam(), circle);
  for (double u = 0.1; u < 16; u += 0.3) EXPECT_GT(spline.normal(u)->dot(spline.at(u)), 0.9 * spline.at(u).norm());
}

TEST_P(ClosedSplineOf, CentroidGradientIsThatOfDifferences) {
  Dice dice(3);
  for (int repeat = 0; repeat < 5; ++repeat) {
    ClosedSpline spline = random_spline(GetParam(), 9 + repeat, dice);
    const auto gradient = spline.centroid_gradient();
    const double h = 1e-5;
    for (int i = 0; i < 2 * spline.count(); ++i) {
      double& coordinate = spline.control_points()[i / 2][i % 2];
      const double value = coordinate;
      coordinate = value + h;
      const Vector<2> more = spline.centroid();
      coordinate = value - h;
      const Vector<2> less = spline.centroid();
      coordinate = value;
      EXPECT_NEAR((gradient.col(i) - (more - less) / (2 * h)).norm(), 0, 1e-7) << i;
    }
  }
}

TEST_P(ClosedSplineOf, EvenlySpacedPlacesAreEvenlySpaced) {
  Dice dice(4);
  for (int repeat = 0; repeat < 10; ++repeat) {
    const ClosedSpline spline = random_spline(GetParam(), 8 + repeat, dice);
    std::vector<double> locations(24);
    spline.evenly_spaced(locations);
    EXPECT_NEAR(locations[0], 0, 1e-12);
    for (std::size_t i = 0; i < locations.size(); ++i) {
      const double from = locations[i], to = i + 1 < locations.size() ? locations[i + 1] : spline.count();
      double length = 0;
      for (int step = 0; step < 500; ++step) {
        length += (spline.at(from + (to - from) * (step + 1) / 500) - spline.at(from + (to - from) * step / 500)).norm();
      }
      EXPECT_NEAR(length, spline.length() / 24, 0.02 * spline.length() / 24);
    }
  }
}

TEST(ClosedSpline, ACurveThatIsAPointHasACentreAndNoNormal) {
  const ClosedSpline spline(4, std::vector<Vector<2>>(6, Vector<2>(3, 4)));
  EXPECT_NEAR(spline.area(), 0, 1e-20);
  EXPECT_NEAR((spline.centroid() - Vector<2>(3, 4)).norm(), 0, 1e-12);
  EXPECT_TRUE(spline.centroid_gradient().allFinite());
  EXPECT_FALSE(spline.normal(1.3).has_value());
  std::vector<double> locations(7);
  spline.evenly_spaced(locations);
  for (const double location : locations) EXPECT_TRUE(std::isfinite(location));
}

TEST(FitSpline, ASplinesOwnPolygonGivesItBack) {
  Dice dice(5);
  for (const int order : {3, 4}) {
    // A circle goes evenly with its length, so that the fit's parameter is the curve's.
    std::vector<Vector<2>> circle;
    for (int i = 0; i < 12; ++i) {
      circle.emplace_back(50 + 30 * std::sin(i * std::numbers::pi / 6), 60 - 30 * std::cos(i * std::numbers::pi / 6));
    }
    const ClosedSpline spline(order, circle);
    const auto fitted = fit_spline(spline.polygon(200), {.order = order, .minimum = 12, .maximum = 12});
    ASSERT_TRUE(fitted.has_value());
    for (int i = 0; i < 12; ++i) EXPECT_NEAR((fitted->control_points()[i] - circle[i]).norm(), 0, 0.02) << order << " " << i;
  }
}

TEST(FitSpline, FewestPointsWithinTheToleranceAreTaken) {
  Dice dice(6);
  const auto polygon = random_spline(4, 16, dice).polygon(20);
  int before = 100;
  for (const double tolerance : {0.01, 0.1, 0.5, 2.0}) {
    const auto fitted = fit_spline(polygon, {.tolerance = tolerance});
    ASSERT_TRUE(fitted.has_value());
    EXPECT_LE(fitted->count(), std::min(before, 24));
    EXPECT_GE(fitted->count(), 8);
    before = fitted->count();
  }
  EXPECT_EQ(before, 8);
}

TEST(FitSpline, TheSenseOfThePolygonDoesNotMatter) {
  Dice dice(7);
  auto polygon = random_spline(4, 10, dice).polygon(20);
  const auto one = fit_spline(polygon, {.minimum = 10, .maximum = 10});
  std::reverse(polygon.begin(), polygon.end());
  const auto other = fit_spline(polygon, {.minimum = 10, .maximum = 10});
  ASSERT_TRUE(one && other);
  for (int i = 0; i < 10; ++i) EXPECT_NEAR((one->control_points()[i] - other->control_points()[i]).norm(), 0, 1e-9);
  EXPECT_GT(one->area(), 0);
}

TEST(FitSpline, FitsSinglePixelAndEmptyPolygon) {
  const std::vector<Vector<2>> pixel = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
  const auto fitted = fit_spline(pixel, {.minimum = 24, .maximum = 24});
  ASSERT_TRUE(fitted.has_value());
  EXPECT_EQ(fitted->count(), 4) << "no more control points than px of length";
  EXPECT_NEAR(fitted->centroid().norm(), 0, 1e-9);
  EXPECT_FALSE(fit_spline(pixel, {.order = 5}).has_value());
  EXPECT_FALSE(fit_spline({}).has_value());
  EXPECT_FALSE(fit_spline(std::vector<Vector<2>>{{0, 0}, {9, 0}}).has_value());
  EXPECT_FALSE(fit_spline(std::vector<Vector<2>>{{0, 0}, {9, 0}, {18, 0}}).has_value());
  EXPECT_FALSE(fit_spline(std::vector<Vector<2>>{{0, 0}, {9, 0}, {5, std::nan("")}}).has_value());
}

TEST(FitSpline, RandomPolygonsNeverGiveWhatIsNotFinite) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    Dice dice(seed);
    std::vector<Vector<2>> polygon;
    const int corners = static_cast<int>(dice.uniform(0, 40));
    const double size = std::pow(10, dice.uniform(-2, 4));
    for (int i = 0; i < corners; ++i) polygon.emplace_back(dice.uniform(0, size), dice.uniform(0, size));
    if (corners > 4 && seed % 5 == 0) polygon[3] = polygon[2];
    const auto fitted = fit_spline(polygon, {.order = 2 + static_cast<int>(seed % 7)});
    if (!fitted) continue;
    for (const Vector<2>& point : fitted->control_points()) EXPECT_TRUE(point.allFinite()) << "seed " << seed;
    EXPECT_TRUE(fitted->centroid().allFinite() && fitted->centroid_gradient().allFinite()) << "seed " << seed;
  }
}

}  // namespace
}  // namespace marey::geometry
