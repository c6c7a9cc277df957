#include "marey/pipeline/judge_match.h"

#include <gtest/gtest.h>

namespace marey::pipeline {
namespace {

/// Two people who run straight at 2 and 4 m/s for 10 s.
GroundRecording runners(double rate_hz, int first_frame = 0, double shift_m = 0, bool with_velocity = true) {
  GroundRecording recording;
  recording.people = {{1, "", ""}, {2, "", ""}};
  for (int i = 0; i <= static_cast<int>(10 * rate_hz); ++i) {
    for (int person = 0; person < 2; ++person) {
      const double time = i / rate_hz, speed = 2 * (person + 1);
      GroundRecording::Sample sample;
      sample.frame = first_frame + i, sample.person = person, sample.time = time;
      sample.place = {10 + speed * time, 20.0 * person + shift_m};
      if (with_velocity) sample.velocity = {speed, 0};
      recording.samples.push_back(sample);
    }
  }
  return recording;
}

TEST(JudgeMatch, SameRateGoesByFrame) {
  const MatchJudgement judgement = judge_match(runners(25), runners(25, 0, 0.3), 1);
  EXPECT_FALSE(judgement.by_time);
  EXPECT_TRUE(judgement.warnings.empty());
  EXPECT_EQ(judgement.evaluation.scores.clear.matches, 502);
  EXPECT_NEAR(judgement.evaluation.position->rms, 0.3, 1e-9);
  EXPECT_NEAR(judgement.evaluation.speed->rms, 0, 1e-9);
  EXPECT_NEAR(*judgement.distance_error, 0, 1e-9);
}

TEST(JudgeMatch, OtherRatesGoByTime) {
  for (const double rate : {5.0, 12.5, 100.0}) {
    const MatchJudgement judgement = judge_match(runners(25), runners(rate), 1);
    EXPECT_TRUE(judgement.by_time) << rate;
    EXPECT_EQ(judgement.warnings.size(), 2U) << rate;
    EXPECT_DOUBLE_EQ(*judgement.evaluation.scores.clear.mota, 1) << rate;
    EXPECT_NEAR(judgement.evaluation.position->p95, 0, 1e-9) << rate;
    EXPECT_NEAR(*judgement.distance_error, 0, 1e-6) << rate;
  }
}

TEST(JudgeMatch, SparseTruthIsJudgedWhereItIs) {
  GroundRecording truth = runners(25, 0, 0, false);
  std::erase_if(truth.samples, [](const auto& sample) { return sample.frame % 25 != 0; });
  const MatchJudgement judgement = judge_match(truth, runners(25), 1);
  EXPECT_FALSE(judgement.by_time);
  EXPECT_EQ(judgement.evaluation.scores.clear.matches, 22);
  EXPECT_EQ(judgement.evaluation.scores.clear.false_positives, 0);
  EXPECT_FALSE(judgement.has_speed) << "nothing tells how fast people are between instants a second apart";
  EXPECT_FALSE(judgement.distance_error);
}

TEST(JudgeMatch, SpeedsThatAFileLacksComeFromItsWays) {
  const MatchJudgement judgement = judge_match(runners(25, 0, 0, false), runners(25), 1);
  EXPECT_TRUE(judgement.has_speed);
  EXPECT_NEAR(judgement.evaluation.speed->rms, 0, 1e-4);
}

TEST(JudgeMatch, ClocksThatDisagreeAreTold) {
  GroundRecording tracks = runners(25);
  for (auto& sample : tracks.samples) sample.time += 2;
  const MatchJudgement judgement = judge_match(runners(25), tracks, 1);
  ASSERT_EQ(judgement.warnings.size(), 1U);
  EXPECT_NE(judgement.warnings[0].find("2 s later"), std::string::npos);
  EXPECT_DOUBLE_EQ(*judgement.evaluation.scores.clear.mota, 1);
}

TEST(JudgeMatch, ALongerWayIsAnError) {
  GroundRecording tracks = runners(25);
  for (auto& sample : tracks.samples) sample.place.x() += 0.01 * (sample.place.x() - 10);
  EXPECT_NEAR(*judge_match(runners(25), tracks, 1.5).distance_error, 0.01, 1e-3);
}

TEST(JudgeMatch, NobodyIsAnAnswerToo) {
  const MatchJudgement judgement = judge_match({}, {}, 1);
  EXPECT_FALSE(judgement.evaluation.scores.clear.mota);
  EXPECT_EQ(judge_match(runners(25), {}, 1).evaluation.scores.clear.misses, 502);
}

}  // namespace
}  // namespace marey::pipeline
