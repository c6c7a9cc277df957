#include "marey/calibrate/pitch/ground_pair.h"

#include <gtest/gtest.h>

#include "marey/calibrate/board/board_scene_test.h"

namespace marey::calibrate::pitch {
namespace {

using board::Noise;

/// People who run in curves of their own.
Vector<2> at(int person, double t) {
  return {20 + 3.5 * person + 7 * std::sin(0.5 * t + person), 15 + 2.5 * person + 6 * std::cos(0.7 * t + 2.3 * person)};
}

/// What a camera sees of six of them whose clock shows `offset_s` less than the world's.
std::vector<SmoothPath> detected(double offset_s, double seconds, std::uint64_t seed, const Vector<2>& systematic = {0, 0},
                                 int first = 0) {
  Noise noise(seed);
  std::vector<SmoothPath> paths;
  for (int person = first; person < first + 6; ++person) {
    GroundPath path;
    for (int i = 0; i < static_cast<int>(25 * seconds); ++i) {
      const double own = i / 25.0;
      path.samples.push_back({own, at(person, own + offset_s) + systematic + Vector<2>(noise.gaussian(0.1), noise.gaussian(0.1)),
                              Matrix<2>::Identity() * 0.01});
    }
    paths.emplace_back(path);
  }
  return paths;
}

TEST(GroundPair, FindsTheShiftWhateverIsSystematic) {
  for (const double offset : {-3.37, 0.0, 1.234}) {
    SCOPED_TRACE(offset);
    const auto a = detected(0, 20, 1), b = detected(offset, 20, 2, {0.4, -0.3});
    GroundPair pair(a, b, {.max_offset_s = 8});
    const GroundOffset found = pair.find();
    ASSERT_EQ(found.verdict, OffsetVerdict::found);
    EXPECT_NEAR(found.offset_s, offset, 0.04);
    EXPECT_LT(found.deviation_s, 0.05);
    EXPECT_LT(std::abs(found.offset_s - offset), 5 * found.deviation_s);
  }
}

TEST(GroundPair, TheScoreIsBestAtTheTruth) {
  const auto a = detected(0, 20, 3), b = detected(0.8, 20, 4);
  const GroundPair pair(a, b, {.max_offset_s = 8});
  const double best = pair.score(0.8);
  for (const double other : {-4.0, 0.0, 0.5, 1.1, 3.0}) EXPECT_LT(pair.score(other), best - 3) << other;
}

TEST(GroundPair, KnowingWhereToLookFindsTheSame) {
  const auto a = detected(0, 20, 5), b = detected(0.6, 20, 6);
  GroundPair pair(a, b, {.max_offset_s = 8});
  const GroundOffset anywhere = pair.find(), near = pair.find(0.5);
  ASSERT_EQ(near.verdict, OffsetVerdict::found);
  EXPECT_NEAR(near.offset_s, anywhere.offset_s, 0.01);
}

TEST(GroundPair, CamerasThatSeeNobodyInCommonHaveNone) {
  const auto a = detected(0, 20, 7), no_person = std::vector<SmoothPath>{}, far = detected(0, 20, 8, {200, 100});
  EXPECT_EQ(GroundPair(a, no_person, {}).find().verdict, OffsetVerdict::no_overlap);
  EXPECT_EQ(GroundPair(a, far, {}).find().verdict, OffsetVerdict::no_overlap);
  EXPECT_EQ(GroundPair(a, far, {}).overlap_s(), 0);
  const auto b = detected(0, 20, 9);
  EXPECT_GT(GroundPair(a, b, {}).overlap_s(), 60) << "six people for twenty seconds";
}

}  // namespace
}  // namespace marey::calibrate::pitch
