// The whole of a wand's calibration on a scene whose truth is known; long recordings with ghosts are in pipeline's tests.
#include "marey/calibrate/wand/wand.h"

#include <gtest/gtest.h>

#include "marey/calibrate/wand/wand_scene_test.h"

namespace marey::calibrate::wand {
namespace {

WandInput input_of(WandScene& scene, int frames, double sigma, bool lenses = true) {
  WandInput input{scene.rig, scene.wand, std::vector<std::vector<BlobFrame>>(scene.rig.cameras.size())};
  for (std::size_t c = 0; c < input.detected.size(); ++c) {
    input.rig.cameras[c].camera_from_world.reset();
    if (!lenses) input.rig.cameras[c].lens.reset();
    for (int i = 0; i < frames; ++i) {
      BlobFrame frame{i / 30.0, {}};
      if (const auto marks = scene.detected(c, frame.time_s, sigma)) {
        for (const auto& mark : *marks) frame.blobs.push_back(*mark);
      }
      input.detected[c].push_back(frame);
    }
  }
  return input;
}

/// m: the worst difference of a distance between two cameras.
double worst_distance(const Rig& found, const Rig& truth) {
  double worst = 0;
  const auto distance = [](const Rig& rig, std::size_t a, std::size_t b) {
    return (rig.cameras[a].camera()->centre() - rig.cameras[b].camera()->centre()).norm();
  };
  for (std::size_t a = 0; a < truth.cameras.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) worst = std::max(worst, std::abs(distance(found, a, b) - distance(truth, a, b)));
  }
  return worst;
}

TEST(Wand, ARigIsFoundWithItsScaleAndItsReport) {
  WandScene scene(1);
  const WandResult result = calibrate_wand(input_of(scene, 300, 0.1), {.lens = LensUse::fixed, .find_offsets = false});
  EXPECT_LT(worst_distance(result.rig, scene.rig), 0.004);
  EXPECT_NEAR(result.report.noise_px, 0.1, 0.02);
  EXPECT_EQ(result.report.cameras.size(), 4U);
  ASSERT_TRUE(result.report.held_out);
  EXPECT_LT(std::abs(result.report.held_out->length_mean_mm), 0.5);
  ASSERT_TRUE(result.rig.calibration);
  EXPECT_EQ(result.rig.calibration->method, "wand");
  EXPECT_FALSE(result.report.grade.empty());
}

TEST(Wand, UnknownLensesAreEstimated) {
  WandScene scene(2);
  const WandResult result = calibrate_wand(input_of(scene, 300, 0.1, false), {.find_offsets = false});
  EXPECT_LT(worst_distance(result.rig, scene.rig), 0.05);
  for (std::size_t c = 0; c < 4; ++c)
    EXPECT_NEAR(geometry::focal_of(*result.rig.cameras[c].lens).x(), 1100 + 10.0 * static_cast<double>(c), 15);
}

TEST(Wand, EndsWhereItIsAskedTo) {
  WandScene scene(3);
  std::stop_source source;
  int steps = 0;
  const Hooks hooks{.progress =
                        [&](const Progress&) {
                          if (++steps == 2) source.request_stop();
                        },
                    .stop = source.get_token()};
  EXPECT_THROW(calibrate_wand(input_of(scene, 200, 0.1), {}, hooks), Stopped);
  EXPECT_EQ(steps, 2);
}

TEST(Wand, TheStepsAreReported) {
  WandScene scene(3);
  std::vector<std::string> steps;
  const Hooks hooks{.progress = [&](const Progress& now) { steps.emplace_back(now.step); }};
  calibrate_wand(input_of(scene, 200, 0.1), {.lens = LensUse::fixed, .find_offsets = false}, hooks);
  EXPECT_EQ(steps, (std::vector<std::string>{"finding the wand", "relating the cameras", "looking again", "adjusting everything"}));
}

TEST(Wand, AWandThatWasHardlySeenIsRefused) {
  WandScene scene(4);
  EXPECT_NE(refusal([&] { calibrate_wand(input_of(scene, 10, 0.1)); }).find("of 10 frames"), std::string::npos);
}

}  // namespace
}  // namespace marey::calibrate::wand
