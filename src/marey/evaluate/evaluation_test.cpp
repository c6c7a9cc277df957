#include "marey/evaluate/evaluation.h"

#include <gtest/gtest.h>

#include "marey/core/error.h"

namespace marey::evaluate {
namespace {

LabelledBox box_at(int frame, int id, double left) {
  return {frame, id, {left, 0, 10, 10}, 1};
}

TEST(Evaluation, PerfectTracksArePerfectWhateverTheirNames) {
  std::vector<LabelledBox> truth;
  std::vector<LabelledBox> tracks;
  for (int frame = 0; frame < 10; ++frame) {
    for (int id = 0; id < 3; ++id) {
      truth.push_back(box_at(frame, id, 20.0 * id + frame));
      tracks.push_back(box_at(frame, 100 - id, 20.0 * id + frame));
    }
  }
  const Evaluation result = evaluate(truth, tracks);
  EXPECT_EQ(result.frames, 10);
  EXPECT_EQ(result.clear.matches, 30);
  EXPECT_EQ(result.clear.mostly_tracked, 3);
  EXPECT_DOUBLE_EQ(*result.clear.mota, 1);
  EXPECT_DOUBLE_EQ(*result.clear.motp, 0);
  EXPECT_DOUBLE_EQ(*result.identity.f1, 1);
  EXPECT_NEAR(result.hota.hota, 1, 1e-12);
  EXPECT_NEAR(result.hota.localisation, 1, 1e-12);
}

TEST(Evaluation, SwitchAndGapCountedByHand) {
  // One object, ten frames: track 1 in frames 0–3, nothing in 4 and 5, track 2 in 6–9, and a false box in frame 0.
  std::vector<LabelledBox> truth;
  std::vector<LabelledBox> tracks{box_at(0, 9, 500)};
  for (int frame = 0; frame < 10; ++frame) {
    truth.push_back(box_at(frame, 1, 0));
    if (frame < 4) tracks.push_back(box_at(frame, 1, 0));
    if (frame >= 6) tracks.push_back(box_at(frame, 2, 0));
  }
  const Evaluation result = evaluate(truth, tracks);
  EXPECT_EQ(result.clear.switches, 1);
  EXPECT_EQ(result.clear.fragmentations, 1);
  EXPECT_EQ(result.clear.misses, 2);
  EXPECT_EQ(result.clear.false_positives, 1);
  EXPECT_EQ(result.clear.mostly_tracked, 1) << "8 of 10 is mostly tracked";
  EXPECT_DOUBLE_EQ(*result.clear.mota, 1 - 4.0 / 10);
  EXPECT_EQ(result.identity.true_positives, 4);
  EXPECT_DOUBLE_EQ(*result.identity.f1, 2 * 4.0 / 19);
  // At every level: 8 matches, DetA = 8 / 11, AssA = (4 · 4/10 + 4 · 4/10) / 8 = 0.4.
  EXPECT_NEAR(result.hota.detection, 8.0 / 11, 1e-12);
  EXPECT_NEAR(result.hota.association, 0.4, 1e-12);
}

TEST(Evaluation, LastMatchIsKeptAgainstANearerTrack) {
  const std::vector<LabelledBox> truth{box_at(0, 1, 0), box_at(1, 1, 0)};
  const std::vector<LabelledBox> tracks{box_at(0, 1, 0), box_at(1, 1, 2), box_at(1, 2, 0)};
  EXPECT_EQ(evaluate(truth, tracks).clear.switches, 0);
  EXPECT_EQ(evaluate(truth, tracks, 0.9).clear.switches, 1) << "the last match no longer overlaps enough";
}

TEST(Evaluation, NothingToJudge) {
  const std::vector<LabelledBox> some{box_at(0, 1, 0), box_at(1, 1, 0)};
  const Evaluation none = evaluate({}, {});
  EXPECT_EQ(none.frames, 0);
  EXPECT_FALSE(none.clear.mota || none.clear.motp || none.identity.f1);
  const Evaluation no_tracks = evaluate(some, {});
  EXPECT_DOUBLE_EQ(*no_tracks.clear.mota, 0);
  EXPECT_EQ(no_tracks.clear.mostly_lost, 1);
  EXPECT_DOUBLE_EQ(*no_tracks.identity.f1, 0);
  EXPECT_EQ(no_tracks.hota.hota, 0);
  EXPECT_EQ(no_tracks.hota.localisation, 1);
  const Evaluation no_truth = evaluate({}, some);
  EXPECT_FALSE(no_truth.clear.mota);
  EXPECT_EQ(no_truth.clear.false_positives, 2);
}

TEST(Evaluation, FramesThatDoNotMeet) {
  const std::vector<LabelledBox> truth{box_at(0, 1, 0)};
  const std::vector<LabelledBox> tracks{box_at(7, 1, 0)};
  const Evaluation result = evaluate(truth, tracks);
  EXPECT_EQ(result.frames, 2);
  EXPECT_EQ(result.common_frames, 0);
  EXPECT_DOUBLE_EQ(*result.clear.mota, -1);
}

TEST(Evaluation, ACrowdBeyondTheLimitIsRefusedAndTheLimitCanBeRaised) {
  std::vector<LabelledBox> boxes(50);
  for (int i = 0; i < 50; ++i) {
    boxes[static_cast<std::size_t>(i)].id = i;
    boxes[static_cast<std::size_t>(i)].box = {20.0 * i, 0, 10, 10};
  }
  Limits limits;
  limits.pairs_a_frame = 2499;
  EXPECT_THROW(evaluate(boxes, boxes, 0.5, limits), Error);
  limits.pairs_a_frame = 2500;
  EXPECT_EQ(evaluate(boxes, boxes, 0.5, limits).clear.matches, 50);
  std::vector<LabelledBox> many(8000);
  for (int i = 0; i < 8000; ++i) many[static_cast<std::size_t>(i)] = {.id = i, .box = {0, 0, 10, 10}};
  EXPECT_THROW(evaluate(many, many), Error);
}

}  // namespace
}  // namespace marey::evaluate
