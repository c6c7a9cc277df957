#include "marey/simulate/match/foot_errors.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "marey/simulate/match/match_camera.h"

namespace marey::simulate::match {
namespace {

TEST(FootErrors, LastAsLongAsTheyShould) {
  constexpr double sigma = 0.25, dt = 0.04;
  FootErrors errors(sigma, 7);
  std::vector<Vector<2>> of_all;  // person by person within each instant
  constexpr int instants = 4000;
  for (int k = 0; k < instants; ++k) {
    for (int i = 0; i < kMatchPeople; ++i) of_all.push_back(errors.of(i));
    errors.advance(dt);
  }
  for (const int lag : {0, 1, 5, 12, 25}) {
    double sum = 0;
    const std::size_t apart = static_cast<std::size_t>(lag) * kMatchPeople;
    for (std::size_t k = 0; k + apart < of_all.size(); ++k) sum += of_all[k].dot(of_all[k + apart]) / 2;
    const double found = sum / static_cast<double>(of_all.size() - apart);
    EXPECT_NEAR(found, FootErrors::covariance(sigma, lag * dt), 0.05 * sigma * sigma) << "after " << lag << " frames";
  }
  // As the recording has it: .75, .40, .25, .07 after 1, 5, 12 and 25 frames.
  EXPECT_NEAR(FootErrors::covariance(1, 1 * dt), 0.75, 0.03);
  EXPECT_NEAR(FootErrors::covariance(1, 5 * dt), 0.40, 0.03);
  EXPECT_NEAR(FootErrors::covariance(1, 25 * dt), 0.07, 0.03);
}

/// Differences of the places of boxes' feet from the truth, m, of a detector that errs in nothing else.
std::vector<Vector<2>> found_errors(double foot_error) {
  MatchCamerasOptions cameras;
  cameras.cameras = 1;
  cameras.distorted = false;
  const MatchScene scene(cameras, 3);
  const MatchDetectorOptions detector{.missed = 0, .size_noise = 0, .false_alarms = 0, .hidden_found = 1, .foot_error = foot_error};
  MatchCamera camera(scene, 0, detector, {});
  MatchTruth truth(scene);
  const GroundView view = *scene.rig.cameras[0].ground_view(scene.rig.ground);
  std::vector<Vector<2>> errors;
  for (int frame = 0; frame < 250; ++frame) {
    camera.advance();
    const Instant instant = truth.next({&camera, 1});
    for (const LabelledBox& box : camera.detect()) {
      const auto location = view.location(box.box.foot());
      if (!location || box.box.bottom() > view.size().height - 3) continue;
      Vector<2> nearest(1e3, 1e3);
      for (const Sample& sample : instant.samples) {
        const Vector<2> apart = location->ground - sample.position.head<2>();
        if (apart.norm() < nearest.norm()) nearest = apart;
      }
      if (nearest.norm() < 1.2) errors.push_back(nearest);
    }
  }
  return errors;
}

TEST(FootErrors, MoveTheBoxesOfADetector) {
  const auto variance = [](const std::vector<Vector<2>>& errors) {
    Vector<2> mean = Vector<2>::Zero();
    for (const Vector<2>& error : errors) mean += error / static_cast<double>(errors.size());
    double sum = 0;
    for (const Vector<2>& error : errors) sum += (error - mean).squaredNorm() / 2;
    return sum / static_cast<double>(errors.size());
  };
  const std::vector<Vector<2>> without = found_errors(0), with = found_errors(0.25);
  ASSERT_GT(without.size(), 500u);
  ASSERT_GT(with.size(), 500u);
  EXPECT_NEAR(std::sqrt(variance(with) - variance(without)), 0.25, 0.04);
}

}  // namespace
}  // namespace marey::simulate::match
