#include "marey/pipeline/calibrate/calibrate_ptz.h"

#include <cmath>

#include <gtest/gtest.h>

#include "marey/simulate/match/ptz_match.h"

namespace marey::pipeline::calibrate {
namespace {

using marey::calibrate::ptz::PtzResult;
using marey::calibrate::ptz::PtzTracker;
using marey::simulate::match::PtzMatch;
using marey::simulate::match::PtzMatchOptions;

PtzMatchOptions ptz_video() {
  PtzMatchOptions options;
  options.size = {640, 360};
  options.people = false;
  return options;
}

struct TrackedPtz {
  PtzResult result;
  std::vector<std::optional<geometry::Heading>> truth;
};

/// From the exact tripod, but a little of its place, without clicks: the first image has to give where the camera is aimed.
TrackedPtz track_ptz(const PtzMatchOptions& options, int frames) {
  PtzMatch match(options, 2);
  geometry::Tripod tripod = match.tripod();
  tripod.location += Vector<3>(0.15, -0.2, 0.1);
  PtzTracker tracker(tripod, options.size);
  TrackedPtz tracked;
  for (int i = 0; i < frames; ++i) {
    match.advance();
    tracker.add(match.image(), match.time());
    tracked.truth.push_back(match.heading());
  }
  tracked.result = tracker.finish();
  return tracked;
}

/// px between where the truth and the answer see the middle of the image's ground.
double rotated_off_px(const TrackedPtz& tracked, std::size_t frame, const geometry::Tripod& tripod, cv::Size size) {
  const Camera truth = geometry::camera_of(tripod, *tracked.truth[frame], size);
  const Camera found = geometry::camera_of(tracked.result.camera.tripod, *tracked.result.camera.rotations[frame].heading, size);
  const auto ray = truth.ray({size.width / 2.0, size.height / 2.0});
  const Vector<3> location = ray->origin - ray->origin.z() / ray->direction.z() * ray->direction;
  return (*found.project(location) - *truth.project(location)).norm();
}

TEST(CalibratePtz, FindsItselfAndStaysOnThePitch) {
  const PtzMatchOptions options = ptz_video();
  const TrackedPtz tracked = track_ptz(options, 40);
  const PtzMatch match(options, 2);
  EXPECT_EQ(tracked.result.lost, 0);
  for (std::size_t i = 0; i < tracked.truth.size(); ++i) {
    ASSERT_TRUE(tracked.result.camera.rotations[i].heading.has_value()) << i;
    EXPECT_LT(rotated_off_px(tracked, i, match.tripod(), options.size), 1.0) << i;
  }
}

TEST(CalibratePtz, IsLostWhileAnotherCameraIsShownAndComesBack) {
  PtzMatchOptions options = ptz_video();
  options.cuts = {{0.4, 0.8}};
  const TrackedPtz tracked = track_ptz(options, 40);
  const PtzMatch match(options, 2);
  int wrong = 0, late = 0;
  for (std::size_t i = 0; i < tracked.truth.size(); ++i) {
    const bool known = tracked.result.camera.rotations[i].heading.has_value();
    wrong += known && !tracked.truth[i] ? 1 : 0;
    late += !known && tracked.truth[i] ? 1 : 0;
    if (known && tracked.truth[i]) {
      EXPECT_LT(rotated_off_px(tracked, i, match.tripod(), options.size), 1.5) << i;
    }
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_LE(late, 5);
}

}  // namespace
}  // namespace marey::pipeline::calibrate
