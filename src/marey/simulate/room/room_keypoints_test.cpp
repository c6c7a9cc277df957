#include "marey/simulate/room/room_keypoints.h"

#include <cmath>

#include <gtest/gtest.h>

namespace marey::simulate::room {
namespace {

RoomOptions keypoint_room() {
  RoomOptions options;
  options.cameras = 4;
  options.markers = 4;
  options.rate_hz = 50;
  options.frames = 400;
  options.image = {1080, 1920};
  options.zoom = 1.3;
  return options;
}

TEST(RoomKeypoints, HaveTheErrorsThatAreAskedFor) {
  const RoomScene scene(keypoint_room());
  const KeypointErrors errors;
  double count = 0, missing = 0, outliers = 0, bias = 0, biases = 0;
  for (int c = 0; c < 4; ++c) {
    const Camera camera = *scene.rig().cameras[static_cast<std::size_t>(c)].camera();
    const KeypointSequence sequence = keypoints_of_camera(scene, c, errors);
    std::vector<Vector<2>> sums(25, Vector<2>::Zero());
    std::vector<double> counts(25, 0);
    for (std::size_t f = 0; f < sequence.frames.size(); ++f) {
      if (sequence.frames[f].empty()) continue;
      const auto truth = true_keypoints(scene, static_cast<double>(f) / 50)[0];
      for (std::size_t i = 0; i < truth.size(); ++i) {
        const auto at = camera.project_with_jacobian(truth[i]);
        if (!at || !camera.in_image(at->pixel)) continue;
        const auto& point = sequence.frames[f][0].points[i];
        missing += point ? 0 : 1;
        ++count;
        if (!point) continue;
        const Vector<2> error = point->position - at->pixel;
        if (error.norm() > 45) {
          ++outliers;
          continue;
        }
        sums[i] += error / std::sqrt(at->by_world.squaredNorm() / 2);
        ++counts[i];
      }
    }
    for (std::size_t i = 0; i < 25; ++i) {
      if (counts[i] < 100) continue;
      bias += (sums[i] / counts[i]).norm();
      ++biases;
    }
  }
  EXPECT_NEAR(missing / count, 0.10, 0.02);
  EXPECT_NEAR(outliers / count, 0.035, 0.015) << "most of the 5 % lie farther off than 45 px";
  EXPECT_NEAR(bias / biases, 0.020, 0.003);
}

TEST(RoomKeypoints, AreTheSameInAnyOrder) {
  const RoomScene scene(keypoint_room());
  const auto once = keypoints_observed(scene, 1, 0.4, 20), again = keypoints_observed(scene, 1, 0.4, 20);
  ASSERT_EQ(once.size(), again.size());
  for (std::size_t i = 0; i < 25; ++i) {
    ASSERT_EQ(once[0].points[i].has_value(), again[0].points[i].has_value());
    if (!once[0].points[i]) continue;
    EXPECT_EQ(once[0].points[i]->position, again[0].points[i]->position);
  }
}

TEST(RoomKeypoints, ExchangeLimbsForAShareOfTheTime) {
  const RoomScene scene(keypoint_room());
  const KeypointErrors errors{.bias_m = 0, .noise_px = 0, .outliers = 0, .missing = 0, .swapped = 0.3};
  const Camera camera = *scene.rig().cameras[0].camera();
  double swapped = 0, all = 0;
  for (std::size_t f = 0; f < 4000; f += 10) {
    const double time_s = static_cast<double>(f) / 50;
    const auto people = keypoints_observed(scene, 0, time_s, f, errors);
    if (people.empty() || !people[0].points[13]) continue;
    const auto truth = true_keypoints(scene, time_s)[0];
    ++all;
    swapped += (people[0].points[13]->position - *camera.project(truth[13])).norm() > 1 ? 1 : 0;
  }
  EXPECT_NEAR(swapped / all, 0.3, 0.1);
}

TEST(RoomKeypoints, RollingShuttersShowEachPointWhenItsRowIsExposed) {
  const RoomScene scene(keypoint_room());
  const KeypointErrors errors{.bias_m = 0, .noise_px = 0, .outliers = 0, .missing = 0, .readout_s = 0.03};
  const Camera camera = *scene.rig().cameras[2].camera();
  double worst = 0, moved = 0;
  int points = 0;
  for (std::uint64_t f = 0; f < 400; f += 5) {
    const double time_s = static_cast<double>(f) / 50;
    const auto people = keypoints_observed(scene, 2, time_s, f, errors);
    if (people.empty()) continue;
    const auto still = true_keypoints(scene, time_s)[0];
    for (std::size_t i = 0; i < still.size(); ++i) {
      if (!people[0].points[i]) continue;
      const Vector<2>& pixel = people[0].points[i]->position;
      const double exposed_s = time_s + errors.readout_s * ((pixel.y() + 0.5) / camera.size().height - 0.5);
      worst = std::max(worst, (pixel - *camera.project(true_keypoints(scene, exposed_s)[0][i])).norm());
      moved = std::max(moved, (pixel - *camera.project(still[i])).norm());
      ++points;
    }
  }
  EXPECT_GT(points, 500);
  EXPECT_GT(moved, 5) << "px, by which a point moves until its row's turn";
  EXPECT_LT(worst, 0.5);
}

}  // namespace
}  // namespace marey::simulate::room
