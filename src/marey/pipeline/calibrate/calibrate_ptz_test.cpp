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

/// Clicks of a frame, all moved by `slip`.
std::vector<marey::calibrate::ptz::ClickedPosition> clicks_in(const PtzMatch& match, const Vector<2>& slip) {
  std::vector<marey::calibrate::ptz::ClickedPosition> clicks;
  for (const auto& click : match.clicks(0.5)) clicks.push_back({click.ground, click.pixel + slip, ""});
  return clicks;
}

/// No image alone gives the camera: clicks in one frame are all there is.
TrackedPtz track_from_clicks(int clicked, const Vector<2>& slip, int frames, bool by_image) {
  const PtzMatchOptions options = ptz_video();
  PtzMatch ahead(options, 2);
  for (int i = 0; i <= clicked; ++i) ahead.advance();
  marey::calibrate::ptz::TrackingOptions tracking;
  if (!by_image) tracking.again.min_agreeing = 1'000'000;
  PtzTracker tracker(ahead.tripod(), options.size, tracking);
  tracker.know(clicked, *ahead.heading(), clicks_in(ahead, slip));
  PtzMatch match(options, 2);
  TrackedPtz tracked;
  for (int i = 0; i < frames; ++i) {
    match.advance();
    tracker.add(match.image(), match.time());
    tracked.truth.push_back(match.heading());
  }
  tracked.result = tracker.finish();
  return tracked;
}

TEST(CalibratePtz, ClicksAreCarriedBackToTheBeginning) {
  const TrackedPtz tracked = track_from_clicks(25, Vector<2>::Zero(), 40, false);
  const PtzMatch match(ptz_video(), 2);
  EXPECT_EQ(tracked.result.lost, 0);
  for (std::size_t i = 0; i < tracked.truth.size(); ++i) {
    ASSERT_TRUE(tracked.result.camera.rotations[i].heading.has_value()) << i;
    EXPECT_LT(rotated_off_px(tracked, i, match.tripod(), ptz_video().size), 1.5) << i;
  }
  ASSERT_EQ(tracked.result.clicks.size(), 1u);
  EXPECT_FALSE(tracked.result.clicks[0].contradicts);
}

TEST(CalibratePtz, ClicksThatTheImageContradictsAreReportedAndTheirFrameIsLost) {
  const TrackedPtz tracked = track_from_clicks(25, Vector<2>(90, 25), 90, true);
  ASSERT_EQ(tracked.result.clicks.size(), 1u);
  ASSERT_TRUE(tracked.result.clicks[0].off_px.has_value());
  EXPECT_TRUE(tracked.result.clicks[0].contradicts);
  EXPECT_GT(*tracked.result.clicks[0].off_px, 60);
  EXPECT_FALSE(tracked.result.camera.rotations[25].heading.has_value());
  EXPECT_FALSE(tracked.result.camera.rotations[35].heading.has_value());
  EXPECT_GT(tracked.result.ambiguous_frames, 20);
}

}  // namespace
}  // namespace marey::pipeline::calibrate
