#include "marey/pipeline/take/evaluate_match.h"

#include <gtest/gtest.h>

#include "marey/core/error.h"

namespace marey::pipeline::take {
namespace {

RecordingHeader on_the_pitch() {
  RecordingHeader header;
  header.name = "match";
  header.frame.kind = FrameOfReference::Kind::user_ground;
  return header;
}

struct Runners {
  double rate_hz = 25;
  double shift_m = 0;
  bool with_velocity = true;
  int every = 1;       ///< frame that is there
  double segment = 1;  ///< of the lengths
  double later_s = 0;  ///< by the clock
};

/// Two people who run straight at 2 and 4 m/s for 10 s.
Recording runners(const Runners& how = {}) {
  Recording recording(on_the_pitch());
  recording.header.rate_hz = how.rate_hz;
  for (int i = 0; i <= static_cast<int>(10 * how.rate_hz); i += how.every) {
    const double time = i / how.rate_hz;
    Instant instant;
    instant.index = i;
    instant.time = timestamp_from_seconds(time + how.later_s);
    for (int person = 0; person < 2; ++person) {
      const double speed = 2 * (person + 1);
      Sample& sample = instant.samples.emplace_back();
      sample.track = TrackId{person + 1};
      sample.position = {10 + how.segment * speed * time, 20.0 * person + how.shift_m, 0};
      if (how.with_velocity) sample.velocity = Vector<3>(speed, 0, 0);
    }
    recording.add(instant);
  }
  return recording;
}

TEST(JudgeMatch, SameRateGoesByFrame) {
  const MatchEvaluation judgement = evaluate_match(runners(), runners({.shift_m = 0.3}), 1);
  EXPECT_FALSE(judgement.by_time);
  EXPECT_TRUE(judgement.warnings.empty());
  EXPECT_EQ(judgement.evaluation.scores.clear.matches, 502);
  EXPECT_NEAR(judgement.evaluation.position->rms, 0.3, 1e-9);
  EXPECT_NEAR(judgement.evaluation.speed->rms, 0, 1e-9);
  EXPECT_NEAR(*judgement.distance_error, 0, 1e-9);
}

TEST(JudgeMatch, OtherRatesGoByTime) {
  for (const double rate : {5.0, 12.5, 100.0}) {
    const MatchEvaluation judgement = evaluate_match(runners(), runners({.rate_hz = rate}), 1);
    EXPECT_TRUE(judgement.by_time) << rate;
    EXPECT_EQ(judgement.warnings.size(), 2U) << rate;
    EXPECT_DOUBLE_EQ(*judgement.evaluation.scores.clear.mota, 1) << rate;
    EXPECT_NEAR(judgement.evaluation.position->p95, 0, 1e-9) << rate;
    EXPECT_NEAR(*judgement.distance_error, 0, 1e-6) << rate;
  }
}

TEST(JudgeMatch, SparseTruthIsJudgedWhereItIs) {
  const MatchEvaluation judgement = evaluate_match(runners({.with_velocity = false, .every = 25}), runners(), 1);
  EXPECT_FALSE(judgement.by_time);
  EXPECT_EQ(judgement.evaluation.scores.clear.matches, 22);
  EXPECT_EQ(judgement.evaluation.scores.clear.false_positives, 0);
  EXPECT_FALSE(judgement.has_speed) << "nothing tells how fast people are between instants a second apart";
  EXPECT_FALSE(judgement.distance_error);
}

TEST(JudgeMatch, SpeedsThatAFileLacksComeFromItsWays) {
  const MatchEvaluation judgement = evaluate_match(runners({.with_velocity = false}), runners(), 1);
  EXPECT_TRUE(judgement.has_speed);
  EXPECT_NEAR(judgement.evaluation.speed->rms, 0, 1e-4);
}

TEST(JudgeMatch, ClocksThatDisagreeAreTold) {
  const MatchEvaluation judgement = evaluate_match(runners(), runners({.later_s = 2}), 1);
  ASSERT_EQ(judgement.warnings.size(), 1U);
  EXPECT_NE(judgement.warnings[0].find("2 s later"), std::string::npos);
  EXPECT_DOUBLE_EQ(*judgement.evaluation.scores.clear.mota, 1);
}

TEST(JudgeMatch, ALongerWayIsAnError) {
  EXPECT_NEAR(*evaluate_match(runners(), runners({.segment = 1.01}), 1.5).distance_error, 0.01, 1e-3);
}

TEST(JudgeMatch, AcceptsEmptyAnswer) {
  const Recording no_person(on_the_pitch());
  const MatchEvaluation judgement = evaluate_match(no_person, no_person, 1);
  EXPECT_FALSE(judgement.evaluation.scores.clear.mota);
  EXPECT_EQ(evaluate_match(runners(), no_person, 1).evaluation.scores.clear.misses, 502);
}

/// The same who climb, in space.
Recording climbers(double shift_m, bool with_velocity) {
  const Recording flat = runners({.with_velocity = with_velocity});
  Recording recording(flat.header);
  recording.header.frame.kind = FrameOfReference::Kind::space;
  InstantsOf instants(flat);
  while (auto instant = instants.next()) {
    for (Sample& sample : instant->samples) {
      sample.position.z() = shift_m + 0.01 * static_cast<double>(instant->index);
      if (sample.velocity) sample.velocity->z() = 0.25;
    }
    recording.add(*instant);
  }
  return recording;
}

TEST(JudgeMatch, MarkersInSpaceAreJudgedInAllThreeDirections) {
  const MatchEvaluation judgement = evaluate_match(climbers(0, true), climbers(0.004, true), 0.01);
  EXPECT_EQ(judgement.evaluation.scores.clear.matches, 502);
  EXPECT_NEAR(judgement.evaluation.position->rms, 0.004, 1e-9);
  EXPECT_TRUE(judgement.has_speed);
  EXPECT_NEAR(judgement.evaluation.velocity->rms, 0, 1e-9);
  EXPECT_TRUE(judgement.path_lengths.empty()) << "path lengths are of people, not of markers";
  EXPECT_EQ(evaluate_match(climbers(0, true), climbers(0.02, true), 0.01).evaluation.scores.clear.matches, 0);
  EXPECT_FALSE(evaluate_match(climbers(0, false), climbers(0, true), 0.01).has_speed);
  EXPECT_THROW(evaluate_match(climbers(0, true), runners(), 0.01), Error) << "the one on the ground, the other in space";
}

TEST(JudgeMatch, PixelsAreRefused) {
  Recording pixels = runners();
  pixels.header.frame.kind = FrameOfReference::Kind::image;
  EXPECT_THROW(evaluate_match(runners(), pixels, 1), Error);
  EXPECT_THROW(evaluate_match(pixels, runners(), 1), Error);
}

}  // namespace
}  // namespace marey::pipeline::take
