#include "marey/calibrate/wand/wand_coverage.h"

#include <gtest/gtest.h>

#include "marey/calibrate/wand/wand_scene_test.h"

namespace marey::calibrate::wand {
namespace {

constexpr double kRate = 50;  // Hz

/// What camera `c` gives between two instants; a camera that sees nothing gives empty frames.
std::vector<BlobFrame> frames_of(WandScene& scene, std::size_t c, double from_s, double to_s, bool observes = true) {
  std::vector<BlobFrame> frames;
  for (double t = from_s; t < to_s; t += 1 / kRate) {
    BlobFrame& frame = frames.emplace_back(BlobFrame{t, {}});
    const auto marks = scene.detected(c, t, 0.1);
    if (!observes || !marks) continue;
    for (std::size_t m = 0; m < scene.wand.markers(); ++m) frame.blobs.push_back(*(*marks)[m]);
  }
  return frames;
}

/// Two seconds at a time, as they come.
template <typename Sees>
WandCoverage waved(WandScene& scene, double duration_s, Sees observes, bool lenses_known = true) {
  WandCoverage coverage(scene.wand, scene.rig.cameras.size(), lenses_known);
  for (double t = 0; t < duration_s; t += 2) {
    std::vector<std::vector<BlobFrame>> frames;
    std::vector<WandCoverage::Detected> detected;
    for (std::size_t c = 0; c < scene.rig.cameras.size(); ++c) {
      frames.push_back(frames_of(scene, c, t, t + 2, observes(c, t)));
      detected.push_back({frames.back(), scene.rig.cameras[c].lens, *scene.rig.cameras[c].size});
    }
    coverage.add(detected, 0.5 / kRate);
  }
  return coverage;
}

TEST(WandCoverage, GrowsUntilItIsEnough) {
  WandScene scene(1);
  const auto always = [](std::size_t, double) { return true; };
  const WandCoverage early = waved(scene, 2, always), late = waved(scene, 40, always);
  EXPECT_FALSE(early.images().is_enough());
  EXPECT_TRUE(late.images().is_enough());
  for (std::size_t c = 0; c < scene.rig.cameras.size(); ++c) {
    EXPECT_GT(early.images().coverage(c), 0);
    EXPECT_GT(late.images().coverage(c), early.images().coverage(c));
    EXPECT_TRUE(late.images().is_covered(c)) << c << " saw " << late.images().coverage(c);
    EXPECT_GT(late.images().views(c), 500);
    EXPECT_EQ(static_cast<double>(late.images().parts(c).size()) / 80, late.images().coverage(c));
    EXPECT_GE(*late.images().parts(c).begin(), 0);
    EXPECT_LT(*late.images().parts(c).rbegin(), 80);
  }
  EXPECT_GE(late.images().shared(0, 1), WandCoverage::kEnoughShared);
  EXPECT_EQ(late.images().shared(0, 1), late.images().shared(1, 0));
}

TEST(WandCoverage, OfLensesThatAreNotKnownMoreIsWanted) {
  WandScene scene(1);
  const auto always = [](std::size_t, double) { return true; };
  for (double t = 2; t <= 60; t += 6) {
    const WandCoverage known = waved(scene, t, always), unknown = waved(scene, t, always, false);
    for (std::size_t c = 0; c < scene.rig.cameras.size(); ++c) {
      EXPECT_EQ(unknown.images().coverage(c), known.images().coverage(c));
      EXPECT_TRUE(known.images().is_covered(c) || !unknown.images().is_covered(c));
      const bool little =
          known.images().coverage(c) < WandCoverage::kLensCovered && unknown.images().views(c) < WandCoverage::kNothingNewOfLens;
      EXPECT_FALSE(little && unknown.images().is_covered(c)) << known.images().coverage(c);
    }
  }
}

TEST(WandCoverage, IsNotEnoughWhereOneCameraSeesNothing) {
  WandScene scene(2);
  const WandCoverage coverage = waved(scene, 40, [](std::size_t c, double) { return c != 2; });
  EXPECT_FALSE(coverage.images().is_enough());
  EXPECT_EQ(coverage.images().coverage(2), 0);
  EXPECT_TRUE(coverage.images().is_covered(1));
}

/// Two pairs that see the wand in turn: each camera is covered, but nothing says how the pairs stand to each other.
TEST(WandCoverage, IsNotEnoughWhereCamerasShareNoViews) {
  WandScene scene(3);
  const WandCoverage coverage =
      waved(scene, 80, [](std::size_t c, double t) { return (c < 2) == (static_cast<int>(t / 10) % 2 == 0); });
  for (std::size_t c = 0; c < 4; ++c) EXPECT_TRUE(coverage.images().is_covered(c)) << c << " saw " << coverage.images().coverage(c);
  EXPECT_FALSE(coverage.images().is_enough());
}

TEST(WandCoverage, CountsNothingBeforeThePictureIsKnown) {
  WandScene scene(4);
  const std::vector<BlobFrame> frames = frames_of(scene, 0, 0, 2);
  WandCoverage coverage(scene.wand, 1);
  coverage.add(std::array{WandCoverage::Detected{frames, {}, {}}}, 0.01);
  EXPECT_EQ(coverage.images().views(0), 0);
}

}  // namespace
}  // namespace marey::calibrate::wand
