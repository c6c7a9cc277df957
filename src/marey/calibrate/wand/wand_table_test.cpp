#include "marey/calibrate/wand/wand_table.h"

#include <gtest/gtest.h>

#include "marey/calibrate/wand/wand_scene_test.h"

namespace marey::calibrate::wand {
namespace {

/// One marker on a cubic: what a cubic through four frames must find exactly.
Vector<2> on_a_cubic(double t) {
  return {100 + 50 * t - 20 * t * t + 3 * t * t * t, 400 - 10 * t + 5 * t * t - t * t * t};
}

MarkTrack cubic_track(int frames, double period_s, double offset_s = 0) {
  MarkTrack track{{}, period_s, offset_s};
  for (int i = 0; i < frames; ++i) track.frames.push_back({i * period_s, {on_a_cubic(i * period_s + offset_s)}});
  return track;
}

TEST(WandTable, CubicWeightsInterpolateCubics) {
  const auto value = [](double x) { return 2 - x + 3 * x * x - 0.5 * x * x * x; };
  for (double u = 0; u <= 1; u += 0.125) {
    const auto w = cubic_weights(u);
    EXPECT_NEAR(w[0] + w[1] + w[2] + w[3], 1, 1e-12);
    EXPECT_NEAR(w[0] * value(-1) + w[1] * value(0) + w[2] * value(1) + w[3] * value(2), value(u), 1e-12) << u;
  }
}

TEST(WandTable, ThePeriodIsTheCommonShortStep) {
  std::vector<BlobFrame> frames;
  double time = 0;
  for (int i = 0; i < 100; ++i) frames.push_back({time += i % 4 == 0 ? 0.5 : 0.02, {}});  // out of sight now and then
  EXPECT_NEAR(period_of(frames), 0.02, 1e-12);
  EXPECT_EQ(period_of(std::span(frames).first(1)), 0);
  EXPECT_EQ(period_of({}), 0);
}

TEST(WandTable, SamplesBetweenFramesLieOnTheCubicThroughThem) {
  const MarkTrack track = cubic_track(20, 0.1, 0.25);
  for (const double time : {0.5, 0.73, 1.234, 1.6}) {  // the rig's clock
    SCOPED_TRACE(time);
    const MarkSamples samples = sample_at(track, time);
    ASSERT_TRUE(samples[0]);
    EXPECT_LT((samples[0]->pixel - on_a_cubic(time)).norm(), 1e-9);
    const Vector<2> slope = (on_a_cubic(time + 1e-5) - on_a_cubic(time - 1e-5)) / 2e-5;
    EXPECT_LT((samples[0]->velocity - slope).norm(), 0.05);
    EXPECT_FALSE(samples[1]);
  }
}

TEST(WandTable, NothingOutsideOrBesideAGap) {
  MarkTrack track = cubic_track(20, 0.1);
  track.frames.erase(track.frames.begin() + 10);
  EXPECT_FALSE(sample_at(track, -0.2)[0]);
  EXPECT_FALSE(sample_at(track, 2.5)[0]);
  EXPECT_FALSE(sample_at(track, 0.05)[0]) << "no frame before the first";
  EXPECT_FALSE(sample_at(track, 0.95)[0]) << "in the gap";
  EXPECT_FALSE(sample_at(track, 0.85)[0]) << "beside it";
  EXPECT_TRUE(sample_at(track, 0.9)[0]) << "a frame's own time";
  EXPECT_EQ(sample_at(track, 0.9)[0]->velocity, Vector<2>(0, 0)) << "its neighbour is missing";
  EXPECT_FALSE(sample_at({}, 0)[0]);
}

TEST(WandTable, CamerasInStepAreComparedAtAllTheirFrames) {
  MarkTrack a = cubic_track(10, 0.1), b = cubic_track(10, 0.1);
  a.frames.erase(a.frames.begin() + 3);
  const auto instants = instants_of(std::vector{a, b});
  ASSERT_EQ(instants.size(), 10U);
  for (std::size_t i = 0; i < instants.size(); ++i) EXPECT_NEAR(instants[i], 0.1 * static_cast<double>(i), 1e-9);
}

TEST(WandTable, CamerasOutOfStepAreComparedAtTheSlowestOnesFrames) {
  MarkTrack slow = cubic_track(10, 0.1), fast = cubic_track(40, 0.025);
  fast.offset_s = 0.011;
  const auto instants = instants_of(std::vector{fast, slow});
  ASSERT_GE(instants.size(), 9U);
  for (std::size_t i = 1; i < instants.size(); ++i) EXPECT_NEAR(instants[i] - instants[i - 1], 0.1, 1e-9);
  EXPECT_TRUE(instants_of({}).empty());
}

TEST(WandTable, ARowHasWhoeverSeesAllMarkers) {
  WandScene scene(1, 3);
  std::vector<MarkTrack> tracks;
  for (std::size_t c = 0; c < 3; ++c) tracks.push_back(scene.track(c, 40, 0));
  tracks[1].frames[5].marks[2].reset();
  const auto instants = instants_of(tracks);
  const MarkTable table = table_of(tracks, instants, 3);
  ASSERT_EQ(table.size(), instants.size());
  for (std::size_t i = 0; i < table.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const auto truth = scene.detected(c, instants[i]);
      const bool whole = truth && !(c == 1 && std::abs(instants[i] - tracks[1].frames[5].time_s) < 1e-9);
      ASSERT_EQ(table[i][c].has_value(), whole) << i << ' ' << c;
      for (std::size_t m = 0; whole && m < 3; ++m) EXPECT_LT((*(*table[i][c])[m] - *(*truth)[m]).norm(), 1e-9);
    }
  }
}

}  // namespace
}  // namespace marey::calibrate::wand
