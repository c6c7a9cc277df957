#include "marey/calibrate/wand/wand_offsets.h"

#include <cmath>

#include <gtest/gtest.h>

#include "marey/calibrate/wand/wand_scene_test.h"

namespace marey::calibrate::wand {
namespace {

/// The scene's wand, waved by a hand: now fast, now slow.
double by_hand(double time_s) {
  return time_s + 0.45 * std::sin(1.7 * time_s) + 0.12 * std::sin(4.1 * time_s + 1) + 0.08 * std::sin(6.7 * time_s + 2);
}

std::vector<MarkTrack> tracks_of(WandScene& scene, const std::vector<double>& offsets, int frames = 500) {
  std::vector<MarkTrack> tracks;
  for (std::size_t c = 0; c < offsets.size(); ++c) {
    MarkTrack& track = tracks.emplace_back(MarkTrack{{}, 0.02, 0});
    for (int i = 0; i < frames; ++i) {
      if (const auto marks = scene.detected(c, by_hand(0.02 * i + offsets[c]), 0.2)) track.frames.push_back({0.02 * i, *marks});
    }
  }
  return tracks;
}

TEST(WandOffsets, CamerasStartedAtOtherTimesAreSetRight) {
  WandScene scene(1, 3);
  auto tracks = tracks_of(scene, {0, 1.36, -0.5});
  EXPECT_TRUE(settle_offsets(tracks, scene.cameras(), scene.wand, 1));
  EXPECT_EQ(tracks[0].offset_s, 0);
  EXPECT_NEAR(tracks[1].offset_s, 1.36, 0.012) << "within a frame; the bundle does the rest";
  EXPECT_NEAR(tracks[2].offset_s, -0.5, 0.012);
}

TEST(WandOffsets, KeepsFittingOffsets) {
  WandScene scene(2, 3);
  auto tracks = tracks_of(scene, {0, 0.7, 0});
  tracks[1].offset_s = 0.7;
  EXPECT_FALSE(settle_offsets(tracks, scene.cameras(), scene.wand, 1));
  EXPECT_EQ(tracks[1].offset_s, 0.7);
}

TEST(WandOffsets, NothingIsClaimedOfACameraThatSawAnotherWand) {
  WandScene scene(3, 3);
  auto tracks = tracks_of(scene, {0, 0, 0}, 300);
  board::Noise noise(3);
  for (MarkFrame& frame : tracks[2].frames) {
    for (auto& mark : frame.marks) mark = Vector<2>(noise.uniform(0, 1279), noise.uniform(0, 1023));
  }
  settle_offsets(tracks, scene.cameras(), scene.wand, 1);
  EXPECT_EQ(tracks[2].offset_s, 0);
  std::vector<MarkTrack> empty(3);
  EXPECT_FALSE(settle_offsets(empty, scene.cameras(), scene.wand, 1));
}

}  // namespace
}  // namespace marey::calibrate::wand
