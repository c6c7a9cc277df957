#include "marey/pipeline/calibrate/calibrate_turning.h"

#include <cmath>

#include <gtest/gtest.h>

#include "marey/simulate/match/turning_match.h"

namespace marey::pipeline::calibrate {
namespace {

using marey::calibrate::turning::TurningFollower;
using marey::calibrate::turning::TurningResult;
using marey::simulate::match::TurningMatch;
using marey::simulate::match::TurningMatchOptions;

TurningMatchOptions turning_film() {
  TurningMatchOptions options;
  options.size = {640, 360};
  options.people = false;
  return options;
}

struct FollowedTurning {
  TurningResult result;
  std::vector<std::optional<geometry::Heading>> truth;
};

/// From the exact tripod, but a little of its place, without clicks: the first picture has to tell where the camera looks.
FollowedTurning follow_turning(const TurningMatchOptions& options, int frames) {
  TurningMatch match(options, 2);
  geometry::Tripod tripod = match.tripod();
  tripod.place += Vector<3>(0.15, -0.2, 0.1);
  TurningFollower follower(tripod, options.size);
  FollowedTurning followed;
  for (int i = 0; i < frames; ++i) {
    match.advance();
    follower.add(match.picture(), match.time());
    followed.truth.push_back(match.heading());
  }
  followed.result = follower.finish();
  return followed;
}

/// px between where the truth and the answer see the middle of the picture's ground.
double turned_off_px(const FollowedTurning& followed, std::size_t frame, const geometry::Tripod& tripod, cv::Size size) {
  const Camera truth = geometry::camera_of(tripod, *followed.truth[frame], size);
  const Camera found = geometry::camera_of(followed.result.camera.tripod, *followed.result.camera.turns[frame].heading, size);
  const auto ray = truth.ray({size.width / 2.0, size.height / 2.0});
  const Vector<3> place = ray->origin - ray->origin.z() / ray->direction.z() * ray->direction;
  return (*found.project(place) - *truth.project(place)).norm();
}

TEST(CalibrateTurning, FindsItselfAndStaysOnThePitch) {
  const TurningMatchOptions options = turning_film();
  const FollowedTurning followed = follow_turning(options, 40);
  const TurningMatch match(options, 2);
  EXPECT_EQ(followed.result.lost, 0);
  for (std::size_t i = 0; i < followed.truth.size(); ++i) {
    ASSERT_TRUE(followed.result.camera.turns[i].heading.has_value()) << i;
    EXPECT_LT(turned_off_px(followed, i, match.tripod(), options.size), 1.0) << i;
  }
}

TEST(CalibrateTurning, IsLostWhileAnotherCameraIsShownAndComesBack) {
  TurningMatchOptions options = turning_film();
  options.cuts = {{0.4, 0.8}};
  const FollowedTurning followed = follow_turning(options, 40);
  const TurningMatch match(options, 2);
  int wrong = 0, late = 0;
  for (std::size_t i = 0; i < followed.truth.size(); ++i) {
    const bool known = followed.result.camera.turns[i].heading.has_value();
    wrong += known && !followed.truth[i] ? 1 : 0;
    late += !known && followed.truth[i] ? 1 : 0;
    if (known && followed.truth[i]) {
      EXPECT_LT(turned_off_px(followed, i, match.tripod(), options.size), 1.5) << i;
    }
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_LE(late, 5);
}

}  // namespace
}  // namespace marey::pipeline::calibrate
