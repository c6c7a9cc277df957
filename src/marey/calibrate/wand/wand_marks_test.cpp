#include "marey/calibrate/wand/wand_marks.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "marey/calibrate/wand/wand_scene_test.h"

namespace marey::calibrate::wand {
namespace {

const cv::Size kSize(1280, 1024);

/// Frames of camera 0: the wand's markers in any order, `ghosts` other blobs a frame, and a lamp that stands still.
std::vector<BlobFrame> frames_of(WandScene& scene, int count, int ghosts) {
  std::vector<BlobFrame> frames;
  for (int i = 0; static_cast<int>(frames.size()) < count; ++i) {
    const auto marks = scene.detected(0, 0.09 * i);
    if (!marks) continue;
    BlobFrame frame{0.09 * i, {}};
    for (std::size_t m = 0; m < scene.wand.markers(); ++m) frame.blobs.push_back(*(*marks)[m]);
    for (int g = 0; g < ghosts; ++g) frame.blobs.emplace_back(scene.noise.uniform(0, 1279), scene.noise.uniform(0, 1023));
    if (ghosts > 0) frame.blobs.emplace_back(64.5, 900.2);
    for (std::size_t k = frame.blobs.size(); k-- > 1;)
      std::swap(frame.blobs[k], frame.blobs[static_cast<std::size_t>(scene.noise.uniform(0, static_cast<double>(k + 1)))]);
    frames.push_back(frame);
  }
  return frames;
}

TEST(WandMarks, ThreeMarkersAreFoundTheRightWayRound) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    WandScene scene(seed);
    const auto found = find_marks(frames_of(scene, 100, 3), scene.wand, scene.rig.cameras[0].lens, kSize);
    int right = 0, wrong = 0;
    for (const MarkFrame& frame : found) {
      const auto truth = scene.detected(0, frame.time_s);
      ASSERT_TRUE(truth);
      double off = 0;
      for (std::size_t m = 0; m < 3; ++m) off = std::max(off, (*frame.marks[m] - *(*truth)[m]).norm());
      (off < 1e-9 ? right : wrong) += 1;
    }
    EXPECT_GE(right, 60) << "of 100";
    EXPECT_LE(wrong, 4);
  }
}

TEST(WandMarks, AViewWithTwoPossibleTriplesDoesNotCount) {
  const MarkerLine wand{{0, 0.12, 0.30}};
  const std::vector<Vector<2>> one{{100, 100}, {180, 100}, {300, 100}};
  std::vector<BlobFrame> frames{{0, one}, {1, one}};
  for (const Vector<2>& blob : one) frames[1].blobs.push_back(blob + Vector<2>(300, 400));
  const auto found = find_marks(frames, wand, {}, kSize);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].time_s, 0);
  EXPECT_EQ(*found[0].marks[1], Vector<2>(180, 100));
}

TEST(WandMarks, ALightCountsWhereItIsAlone) {
  std::vector<BlobFrame> frames;
  for (int i = 0; i < 50; ++i) {
    frames.push_back({0.1 * i, {{20.0 * i + 50, 300}, {640.4, 512.3}}});  // the light, and a lamp that does not move
    if (i % 5 == 0) frames.back().blobs.emplace_back(700 + 5 * i, 100 + 15 * i);
  }
  const auto found = find_marks(frames, {{0}}, {}, kSize);
  EXPECT_EQ(found.size(), 40U);
  for (const MarkFrame& frame : found) EXPECT_EQ(frame.marks[0]->y(), 300);
}

TEST(WandMarks, EmptyFramesAndTooManyBlobsGiveNothing) {
  EXPECT_TRUE(find_marks({}, {{0, 0.1, 0.3}}, {}, kSize).empty());
  BlobFrame crowd{0, {}};
  for (int i = 0; i < 60; ++i) crowd.blobs.emplace_back(20 * i, 17 * i % 900);
  EXPECT_TRUE(find_marks(std::vector{crowd, BlobFrame{}}, {{0, 0.1, 0.3}}, {}, kSize).empty());
}

/// The slow twin: of all matches the nearest pair first, then the nearest of the rest, by inspecting all of them each time.
Marks nearest_first(const BlobFrame& frame, const Marks& expected, double gate) {
  Marks marks;
  std::vector<bool> taken(frame.blobs.size(), false);
  for (;;) {
    double best = gate;
    std::optional<std::pair<std::size_t, std::size_t>> pair;
    for (std::size_t m = 0; m < expected.size(); ++m) {
      for (std::size_t b = 0; b < frame.blobs.size(); ++b) {
        if (!expected[m] || marks[m] || taken[b] || (frame.blobs[b] - *expected[m]).norm() > best) continue;
        best = (frame.blobs[b] - *expected[m]).norm();
        pair = {m, b};
      }
    }
    if (!pair) return marks;
    marks[pair->first] = frame.blobs[pair->second];
    taken[pair->second] = true;
  }
}

TEST(WandMarks, MatchingAgreesWithItsSlowTwin) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    board::Noise noise(seed);
    const auto any = [&] { return Vector<2>(noise.uniform(0, 30), noise.uniform(0, 30)); };
    BlobFrame frame;
    for (int i = 0; i < static_cast<int>(seed % 7); ++i) frame.blobs.push_back(any());
    Marks expected;
    for (auto& mark : expected) {
      if (noise.uniform() < 0.8) mark = any();
    }
    EXPECT_EQ(match_marks(frame, expected, 12), nearest_first(frame, expected, 12));
  }
}

}  // namespace
}  // namespace marey::calibrate::wand
