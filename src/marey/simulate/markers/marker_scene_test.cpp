#include "marey/simulate/markers/marker_scene.h"

#include <gtest/gtest.h>

#include "marey/core/error.h"

namespace marey::simulate::markers {
namespace {

int visible_frames(const MarkerScene& scene, int marker) {
  int count = 0;
  for (const auto& frame : scene.frames) count += frame[marker].visible ? 1 : 0;
  return count;
}

TEST(MarkerScene, TheSameSeedGivesTheSameVideo) {
  for (const NamedSituation& named : marker_situations()) {
    const MarkerScene a = simulate_markers(named.situation, 3);
    const MarkerScene b = simulate_markers(named.situation, 3);
    const MarkerScene c = simulate_markers(named.situation, 4);
    ASSERT_EQ(a.frames.size(), b.frames.size());
    EXPECT_EQ(a.frames.back()[0].position, b.frames.back()[0].position) << named.name;
    EXPECT_NE(a.frames.back()[0].position, c.frames.back()[0].position) << named.name;
  }
}

TEST(MarkerScene, LengthsAreThePapersSamples) {
  EXPECT_EQ(simulate_markers(MarkerSituation::slow_zigzag, 1).frames.size(), 86u);
  EXPECT_EQ(simulate_markers(MarkerSituation::rapid_zigzag, 1).frames.size(), 55u);
  EXPECT_EQ(simulate_markers(MarkerSituation::acceleration, 1).frames.size(), 86u);
}

TEST(MarkerScene, MarkersStayInTheImageAndKeepToTheirSpeeds) {
  for (const NamedSituation& named : marker_situations()) {
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
      const MarkerScene scene = simulate_markers(named.situation, seed);
      for (std::size_t i = 0; i < scene.frames.size(); ++i) {
        for (std::size_t marker = 0; marker < scene.frames[i].size(); ++marker) {
          const Vector<2>& location = scene.frames[i][marker].position;
          ASSERT_TRUE(location.x() > 0 && location.x() < 639 && location.y() > 0 && location.y() < 479)
              << named.name << " seed " << seed;
          if (i > 0) {
            ASSERT_LT((location - scene.frames[i - 1][marker].position).norm(), 60) << named.name << " seed " << seed;
          }
        }
      }
    }
  }
}

TEST(MarkerScene, ABarrierHidesTheMarkerForAWhileAndNeverAtTheEnds) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const MarkerScene scene = simulate_markers(MarkerSituation::occlusion, seed);
    ASSERT_EQ(scene.barriers.size(), 1u);
    EXPECT_TRUE(scene.frames.front()[0].visible) << "seed " << seed;
    EXPECT_TRUE(scene.frames.back()[0].visible) << "seed " << seed;
    EXPECT_LT(visible_frames(scene, 0), std::ssize(scene.frames)) << "seed " << seed;
  }
}

TEST(MarkerScene, ReportsMissingMotionModel) {
  MarkerSceneOptions options;
  for (const int frames : {1, 2, 3, 5, 5000, 1'000'000}) {
    options.frames = frames;
    EXPECT_THROW(simulate_markers(MarkerSituation::crossing, 1, options), Error) << frames;
  }
  EXPECT_THROW(simulate_markers(MarkerSituation::occlusion, 1, options), Error);
  options.frames = 40;
  EXPECT_EQ(simulate_markers(MarkerSituation::crossing, 1, options).frames.size(), 40u);
  options.radius_px = 100;
  EXPECT_THROW(simulate_markers(MarkerSituation::crossing, 1, options), Error);
}

TEST(MarkerScene, CrossingMarkersTouch) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const MarkerScene scene = simulate_markers(MarkerSituation::crossing, seed);
    double nearest = 1e9;
    for (const auto& frame : scene.frames) nearest = std::min(nearest, (frame[0].position - frame[1].position).norm());
    EXPECT_LT(nearest, 2 * scene.options.radius_px) << "seed " << seed;
  }
}

TEST(MarkerScene, KnobsAddMarkersAndClutter) {
  MarkerSceneOptions options;
  options.markers = 30;
  options.clutter = 4;
  options.frames = 12;
  const MarkerScene scene = simulate_markers(MarkerSituation::plain, 1, options);
  ASSERT_EQ(scene.frames.size(), 12u);
  EXPECT_EQ(scene.frames[5].size(), 30u);
  EXPECT_EQ(scene.clutter[5].size(), 4u);
}

}  // namespace
}  // namespace marey::simulate::markers
