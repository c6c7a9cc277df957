#include "marey/pipeline/keypoints/augmenter_input.h"

#include <chrono>
#include <cstdint>
#include <map>
#include <string>

#include <gtest/gtest.h>

namespace marey::pipeline::keypoints {
namespace {

const std::map<std::string, Vector<3>> kStanding = {
    {"shoulder", {0, 0.18, 1.45}}, {"hip", {0, 0.10, 0.95}},      {"knee", {0, 0.10, 0.5}},  {"ankle", {0, 0.10, 0.1}},
    {"heel", {-0.05, 0.10, 0.03}}, {"big_toe", {0.2, 0.08, 0.0}}, {"elbow", {0, 0.2, 1.15}}, {"wrist", {0, 0.2, 0.9}}};

/// Standing, facing x, drifting along x by 1 m/s; `absent` says which points lack at an instant.
template <typename Absent>
Recording standing(double rate_hz, std::size_t instants, bool covariances, Absent&& absent) {
  Recording recording;
  recording.header.rate_hz = rate_hz;
  for (std::size_t t = 0; t < instants; ++t) {
    const auto now = std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 * static_cast<double>(t) / rate_hz));
    recording.add_time_step({.index = static_cast<std::int64_t>(t), .time = Timestamp(now)});
  }
  std::int32_t id = 0;
  for (const std::string side : {"left_", "right_"}) {
    for (const auto& [point, at] : kStanding) {
      TrackColumns track({.id = TrackId{++id}, .label = side + point, .team = {}}, 3);
      for (std::size_t t = 0; t < instants; ++t) {
        if (absent(side + point, t)) continue;
        Sample sample;
        sample.position = Vector<3>(at.x() + static_cast<double>(t) / rate_hz, side == "left_" ? at.y() : -at.y(), at.z());
        if (covariances) sample.covariance = 1e-4 * Matrix<3>::Identity();
        track.add(static_cast<std::int32_t>(t), sample);
      }
      recording.put(std::move(track));
    }
  }
  return recording;
}

bool none_absent(const std::string&, std::size_t) {
  return false;
}

TEST(AugmenterInput, BringsAnyRateToSixtyStepsASecond) {
  for (const double rate : {25.0, 60.0, 200.0}) {
    const auto count = static_cast<std::size_t>(2 * rate) + 1;
    const auto input = augmenter_input(standing(rate, count, true, none_absent), "", HipPoints::as_networks, 30);
    ASSERT_EQ(input.runs.size(), 1U) << rate;
    EXPECT_EQ(input.instants, count);
    EXPECT_TRUE(input.arms);
    EXPECT_TRUE(input.covariances);
    const AugmenterRun& run = input.runs.front();
    ASSERT_EQ(run.steps.size(), 121U) << rate;
    ASSERT_EQ(run.hips.size(), count);
    for (std::size_t k = 0; k < run.steps.size(); ++k)
      ASSERT_NEAR(hips_of(run.steps[k]).x(), static_cast<double>(k) / kAugmenterRate_hz, 1e-6);
    EXPECT_NEAR(run.steps[7].covariance[3](1, 1), 1e-4, 1e-9);
  }
}

TEST(AugmenterInput, PlacesTheSmallToesOutsideTheFeet) {
  const auto input = augmenter_input(standing(60, 60, false, none_absent), "", HipPoints::as_networks, 30);
  EXPECT_FALSE(input.small_toes);
  EXPECT_FALSE(input.covariances);
  const AugmenterStep& step = input.runs.at(0).steps.at(0);
  constexpr std::size_t kSmallToe = 5, kBigToe = 6;
  EXPECT_LT(step.position[2 * kSmallToe].y(), step.position[2 * kBigToe].y() - 0.02);          // right
  EXPECT_GT(step.position[2 * kSmallToe + 1].y(), step.position[2 * kBigToe + 1].y() + 0.02);  // left
  EXPECT_NEAR(step.position[2 * kSmallToe].x(), 0.16, 0.03);
}

TEST(AugmenterInput, MovesCentresOfHipsAheadAndUp) {
  const Recording recording = standing(60, 60, false, none_absent);
  const auto as_they_are = augmenter_input(recording, "", HipPoints::as_networks, 30);
  const auto moved = augmenter_input(recording, "", HipPoints::joint_centres, 30);
  const Vector<3> by = moved.runs.at(0).steps.at(0).position[2] - as_they_are.runs.at(0).steps.at(0).position[2];
  EXPECT_NEAR((by - Vector<3>(0.033, 0, 0.021)).norm(), 0, 1e-9);
}

TEST(AugmenterInput, EndsWhereAPointIsAbsentAndOmitsWhatIsShort) {
  const auto gaps = [](const std::string& point, std::size_t t) { return point == "left_knee" && (t == 50 || t == 60); };
  const auto input = augmenter_input(standing(60, 120, true, gaps), "", HipPoints::as_networks, 30);
  ASSERT_EQ(input.runs.size(), 2U);
  EXPECT_EQ(input.runs[0].last, 49U);
  EXPECT_EQ(input.runs[1].first, 61U);
  EXPECT_EQ(input.instants, 50U + 59U);
}

TEST(AugmenterInput, GoesWithoutArmsThatAreMostlyAbsent) {
  const auto hidden = [](const std::string& point, std::size_t t) { return point == "right_wrist" && t > 20; };
  const auto input = augmenter_input(standing(60, 120, true, hidden), "", HipPoints::as_networks, 30);
  EXPECT_FALSE(input.arms);
  EXPECT_EQ(input.instants, 120U);
}

TEST(AugmenterInput, NamesPointsThatAreNeverThere) {
  const auto without = [](const std::string& point, std::size_t) { return point == "right_heel"; };
  const auto input = augmenter_input(standing(60, 60, true, without), "", HipPoints::as_networks, 30);
  EXPECT_EQ(input.missing, std::vector<std::string>{"heel"});
  EXPECT_TRUE(input.runs.empty());
  EXPECT_TRUE(augmenter_input(standing(60, 60, true, none_absent), "P2:", HipPoints::as_networks, 30).runs.empty());
}

TEST(AugmenterInput, FindsPeopleByAnyProgramsNames) {
  std::vector<TrackName> names;
  std::int32_t id = 0;
  for (const char* point : {"Shoulder", "Hip", "Knee", "Ankle", "Heel", "BigToe"}) {
    for (const char* side : {"L", "R"})
      names.push_back({.id = TrackId{++id}, .label = "P1:" + std::string(side) + point, .team = {}});
  }
  EXPECT_EQ(people_to_augment(names), std::vector<std::string>{"P1:"});
  names.pop_back();
  EXPECT_TRUE(people_to_augment(names).empty());
}

}  // namespace
}  // namespace marey::pipeline::keypoints
