#include "marey/calibrate/rig_report.h"

#include <gtest/gtest.h>

#include "marey/calibrate/wand/wand_scene_test.h"

namespace marey::calibrate {
namespace {

using wand::WandScene;

/// A scene as a bundle at its truth, seen with `sigma` px of noise.
bundle::Bundle bundle_of(WandScene& scene, int instants, double sigma) {
  bundle::Bundle bundle;
  bundle.wand = scene.wand.distances;
  for (const RigCamera& camera : scene.rig.cameras) bundle.cameras.push_back({*camera.lens, *camera.camera_from_world});
  for (int i = 0; i < instants; ++i) {
    const auto locations = scene.markers(0.1 * i);
    bundle.bodies.emplace_back(bundle::WandPose{locations[0], (locations[2] - locations[0]).normalized()});
    for (std::size_t c = 0; c < bundle.cameras.size(); ++c) {
      const auto marks = scene.detected(c, 0.1 * i, sigma);
      for (int m = 0; marks && m < 3; ++m)
        bundle.observations.push_back({static_cast<int>(c), i, m, *(*marks)[static_cast<std::size_t>(m)]});
    }
  }
  return bundle;
}

bundle::BundleResult fit_of(const bundle::Bundle& bundle, double noise_px) {
  bundle::BundleResult fit;
  fit.inlier.assign(bundle.observations.size(), 1);
  fit.noise_px = noise_px;
  return fit;
}

const std::vector<std::string> kNames{"cam1", "cam2", "cam3", "cam4"};
const std::vector<cv::Size> kSizes(4, cv::Size(1280, 1024));

TEST(RigReport, CountsAndErrorsAreThoseOfTheObservations) {
  WandScene scene(1);
  bundle::Bundle bundle = bundle_of(scene, 60, 0);
  for (auto& detected : bundle.observations)
    detected.pixel.x() += detected.camera == 1 ? 3 : 0;  // one camera is 3 px off throughout
  auto fit = fit_of(bundle, 1);
  int of_second = 0, out = 0;
  for (std::size_t i = 0; i < fit.inlier.size(); ++i) {
    if (bundle.observations[i].camera != 1) continue;
    if (++of_second % 5 == 0) fit.inlier[i] = 0, ++out;
  }
  const RigReport report = report_on(bundle, fit, kNames, kSizes);
  EXPECT_EQ(report.all.observations, std::ssize(bundle.observations));
  EXPECT_EQ(report.all.inliers, std::ssize(bundle.observations) - out);
  EXPECT_EQ(report.cameras[1].fit.observations, of_second);
  EXPECT_EQ(report.cameras[1].fit.inliers, of_second - out);
  EXPECT_NEAR(report.cameras[1].fit.mean_px, 3, 1e-6);
  EXPECT_NEAR(report.cameras[1].fit.rms_px, 3, 1e-6);
  EXPECT_NEAR(report.cameras[0].fit.rms_px, 0, 1e-6);
  EXPECT_NEAR(report.cameras[1].world_error_mm, 1000 * 3 * 4 / 1110.0, 5) << "3 px at some 4 m";
  for (const CameraReport& camera : report.cameras) {
    EXPECT_GT(camera.coverage, 0.1) << camera.name;
    EXPECT_LT(camera.coverage, 1) << camera.name;
  }
}

TEST(RigReport, TheVolumeIsWhereTheWandWasAndDeviationsGrowWithNoise) {
  WandScene scene(2);
  const bundle::Bundle bundle = bundle_of(scene, 200, 0);
  const RigReport report = report_on(bundle, fit_of(bundle, 0.5), kNames, kSizes);
  EXPECT_GT(report.volume.high.x() - report.volume.low.x(), 1.4);
  EXPECT_LT(report.volume.high.x() - report.volume.low.x(), 2.5);
  EXPECT_GT(report.volume.observed_by_three, 0.8);
  EXPECT_GE(report.volume.observed_by_two, report.volume.observed_by_three);
  EXPECT_GT(report.volume.median_mm, 0.5);
  EXPECT_LT(report.volume.median_mm, 5);
  const RigReport noisier = report_on(bundle, fit_of(bundle, 1), kNames, kSizes);
  EXPECT_NEAR(noisier.volume.median_mm, 2 * report.volume.median_mm, 1e-9);
}

TEST(RigReport, HeldOutFramesShowNoiseAndLength) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(seed);
    WandScene scene(seed);
    bundle::Bundle bundle = bundle_of(scene, 150, 0.4);
    const HeldOutReport truth = evaluate_held_out(bundle, kSizes);
    EXPECT_EQ(truth.frames, 150);
    EXPECT_NEAR(truth.noise_px, 0.4, 0.03);
    EXPECT_NEAR(truth.length_mean_mm, 0, 0.3);
    EXPECT_LT(truth.length_rms_mm, 3);
    bundle.wand.back() += 0.01;  // said to be 1 cm longer than it is
    EXPECT_NEAR(evaluate_held_out(bundle, kSizes).length_mean_mm, truth.length_mean_mm - 10, 1e-6);
  }
}

TEST(RigReport, NothingSeenIsAReportOfNothing) {
  WandScene scene(3);
  bundle::Bundle bundle = bundle_of(scene, 0, 0);
  const RigReport report = report_on(bundle, fit_of(bundle, 0), kNames, kSizes);
  EXPECT_EQ(report.all.observations, 0);
  EXPECT_EQ(report.volume.median_mm, 0);
  EXPECT_EQ(evaluate_held_out(bundle, kSizes).frames, 0);
}

}  // namespace
}  // namespace marey::calibrate
