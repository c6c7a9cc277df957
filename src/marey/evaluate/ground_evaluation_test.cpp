#include "marey/evaluate/ground_evaluation.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace marey::evaluate {
namespace {

TargetPosition position_at(int frame, int id, double x, double y = 0) {
  return {frame, id, {x, y, 0}, Vector<3>(1, 0, 0)};
}

TEST(GroundEvaluation, ErrorsAreInMetres) {
  std::vector<TargetPosition> truth, tracks;
  for (int frame = 0; frame < 10; ++frame) {
    truth.push_back(position_at(frame, 1, 0.1 * frame));
    truth.push_back(position_at(frame, 2, 50));
    tracks.push_back(position_at(frame, 7, 0.1 * frame, 0.3));
    tracks.back().velocity = {1, 1, 0};
    tracks.push_back(position_at(frame, 8, 50, 0.4));
  }
  const GroundEvaluation result = evaluate_ground(truth, tracks, 1.5);
  EXPECT_EQ(result.scores.clear.matches, 20);
  EXPECT_NEAR(*result.scores.clear.motp, 0.35, 1e-12);
  EXPECT_NEAR(result.position->rms, std::sqrt((0.09 + 0.16) / 2), 1e-12);
  EXPECT_NEAR(result.position->median, 0.35, 1e-12);
  EXPECT_NEAR(result.position->p95, 0.4, 1e-12);
  EXPECT_NEAR(result.speed->p95, std::sqrt(2) - 1, 1e-12);
  EXPECT_NEAR(result.velocity->rms, std::sqrt(0.5), 1e-12);
  EXPECT_TRUE(result.people[0].kept() && result.people[1].kept());
  EXPECT_EQ(result.people[0].track, 7);
}

TEST(GroundEvaluation, FarthestIsStillAMatchAndFartherIsNot) {
  const std::vector<TargetPosition> truth{position_at(0, 1, 0)}, near{position_at(0, 1, 1.5)}, far{position_at(0, 1, 1.5001)};
  EXPECT_EQ(evaluate_ground(truth, near, 1.5).scores.clear.matches, 1);
  const GroundEvaluation missed = evaluate_ground(truth, far, 1.5);
  EXPECT_EQ(missed.scores.clear.matches, 0);
  EXPECT_EQ(missed.scores.clear.false_positives, 1);
  EXPECT_FALSE(missed.position);
}

TEST(GroundEvaluation, ATrackThatChangesThePersonKeepsNobody) {
  std::vector<TargetPosition> truth, tracks;
  for (int frame = 0; frame < 10; ++frame) {
    for (int id : {1, 2}) {
      truth.push_back(position_at(frame, id, 10 * id));
      tracks.push_back(position_at(frame, frame < 5 ? id : 3 - id, 10 * id));
    }
    truth.push_back(position_at(frame, 3, 90));
    if (frame < 7) tracks.push_back(position_at(frame, 3, 90));
  }
  std::sort(tracks.begin(), tracks.end(), [](const auto& a, const auto& b) { return a.frame < b.frame; });
  const GroundEvaluation result = evaluate_ground(truth, tracks, 1);
  EXPECT_EQ(result.scores.clear.switches, 2);
  for (const TargetFate& fate : result.people) EXPECT_FALSE(fate.kept()) << fate.id;
  EXPECT_EQ(result.people[2].agreeing, 7);
}

TEST(GroundEvaluation, NothingToJudge) {
  EXPECT_FALSE(evaluate_ground({}, {}, 1).position);
  const std::vector<TargetPosition> truth{position_at(0, 1, 0)};
  const GroundEvaluation none = evaluate_ground(truth, {}, 1);
  EXPECT_FALSE(none.people[0].track);
  EXPECT_FALSE(none.people[0].kept());
}

}  // namespace
}  // namespace marey::evaluate
