#include "marey/track/contour/outline_report.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "marey/track/contour/silhouette_spline.h"

namespace marey::track::contour {
namespace {

constexpr Box kBox{40, 20, 26, 80};  // px

geometry::ClosedSpline body_of(const Box& box) {
  return standing_body(box, {4, 24, 24}).value();
}

/// A target whose shape fills the box of a body.
ContourTarget target_of(const geometry::ClosedSpline& spline) {
  ContourTarget target{.id = TrackId{1},
                       .shape = ShapeFilter(spline, 0.5),
                       .motion = MotionFilter(spline.centroid(), Vector<2>::Zero(), 0, 1, 1, 1),
                       .height = kBox.height,
                       .typical_area = spline.area(),
                       .tracked_height = kBox.height,
                       .predicted = spline};
  target.state = Outline::State::detected;
  return target;
}

Track<2> track_of(const Box& box) {
  Track<2> track;
  track.id = TrackId{1};
  track.box = box;
  return track;
}

/// The shape above a row: legs are cut off.
geometry::ClosedSpline cut_at(const geometry::ClosedSpline& spline, double row) {
  std::vector<Vector<2>> points = spline.control_points();
  for (Vector<2>& point : points) point.y() = std::min(point.y(), row);
  return {spline.order(), std::move(points)};
}

TEST(BringBack, RestoresLegsThatARegionLost) {
  const geometry::ClosedSpline body = body_of(kBox);
  ContourTarget target = target_of(body);
  bring_back(target, track_of(kBox), nullptr);
  EXPECT_EQ(target.state, Outline::State::detected) << "a shape that fills its box stays";
  EXPECT_EQ(target.shape.spline().control_points(), body.control_points());

  // As the tracker has it in the next frame: one pixel to the right.
  const Box next{kBox.left + 1, kBox.top, kBox.width, kBox.height};
  Detection shared;
  shared.box = next;
  shared.group = 0;
  target.shape = ShapeFilter(cut_at(body, 75), 0.5);
  bring_back(target, track_of(next), &shared);
  const Box own = target.shape.spline().box();
  EXPECT_NEAR(own.bottom(), body.box().bottom(), 2);
  EXPECT_NEAR(own.top, body.box().top, 2);
  EXPECT_EQ(target.state, Outline::State::held);
  EXPECT_EQ(std::ssize(target.hidden), target.shape.spline().count()) << "none of its edge is seen";
}

TEST(BringBack, RestoresLegsBehindSomethingOfTheScene) {
  ContourTarget target = target_of(body_of(kBox));
  bring_back(target, track_of(kBox), nullptr);
  Detection upper;  // alone, and cut off from below
  upper.box = {kBox.left, kBox.top, kBox.width, 50};
  target.shape = ShapeFilter(cut_at(target.shape.spline(), 68), 0.5);
  bring_back(target, track_of(kBox), &upper);
  EXPECT_GT(target.shape.spline().box().bottom(), 95);
}

TEST(BringBack, LeavesABodyThatSquats) {
  ContourTarget target = target_of(body_of(kBox));
  bring_back(target, track_of(kBox), nullptr);
  const Box low{kBox.left, kBox.top + 30, kBox.width, kBox.height - 30};
  Detection alone;
  alone.box = low;
  const geometry::ClosedSpline squatting = body_of(low);
  target.shape = ShapeFilter(squatting, 0.5);
  bring_back(target, track_of(kBox), &alone);  // the tracker's box follows later
  EXPECT_EQ(target.shape.spline().control_points(), squatting.control_points());
  EXPECT_EQ(target.state, Outline::State::detected);
}

TEST(BringBack, ShrinksWhatHasGrown) {
  ContourTarget target = target_of(body_of({kBox.left - 20, kBox.top - 30, 66, 140}));
  bring_back(target, track_of(kBox), nullptr);
  EXPECT_LT(target.shape.spline().box().height, 1.25 * kBox.height);
}

std::vector<Vector<2>> oval(const Vector<2>& centre, double across, double down) {
  std::vector<Vector<2>> polygon;
  for (int i = 0; i < 90; ++i) {
    const double angle = 2 * std::numbers::pi * i / 90;
    polygon.emplace_back(centre + Vector<2>(across * std::cos(angle), down * std::sin(angle)));
  }
  return polygon;
}

TEST(IsOutlineOf, NeitherLoopsNorGiants) {
  const geometry::ClosedSpline plain(4, oval({50, 50}, 10, 30));
  const Box box{38, 18, 24, 64};
  EXPECT_TRUE(is_outline_of(plain, box));
  EXPECT_TRUE(is_outline_of(plain, {45, 18, 9, 64})) << "narrower than a stride";
  const geometry::ClosedSpline wide(4, oval({50, 50}, 60, 30));
  EXPECT_FALSE(is_outline_of(wide, {45, 18, 9, 64})) << "more than twice as wide";
  EXPECT_FALSE(is_outline_of(plain, {38, 18, 24, 36})) << "more than 1.6 times as high";
  const geometry::ClosedSpline eight(
      4, {{0, 0}, {10, 0}, {10, 10}, {-10, 20}, {-10, 30}, {0, 30}, {10, 30}, {10, 20}, {-10, 10}, {-10, 0}});
  EXPECT_FALSE(is_simple(eight));
  const cv::Size image(55, 100);
  EXPECT_FALSE(is_outline_of(wide, {40, 18, 7, 64}, &image));
  EXPECT_TRUE(is_outline_of(wide, {20, 18, 35, 64}, &image)) << "what lies outside does not count";
}

}  // namespace
}  // namespace marey::track::contour
