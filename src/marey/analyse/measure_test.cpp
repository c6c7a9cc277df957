#include "marey/analyse/measure.h"

#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace marey::analyse {
namespace {

GroundRecording one_person(double rate, double seconds, const std::function<Vector<2>(double)>& place, double noise) {
  GroundRecording recording;
  recording.people = {{7, "seven", "white"}};
  std::mt19937 random(5);
  std::normal_distribution<double> off(0, noise);
  for (int i = 0; i <= rate * seconds; ++i) {
    GroundRecording::Sample sample;
    sample.frame = i;
    sample.time = i / rate;
    sample.place = place(sample.time) + Vector<2>(off(random), off(random));
    recording.samples.push_back(sample);
  }
  return recording;
}

Vector<2> running(double t) {
  return {20 + 4 * t, 30};
}

TEST(Measure, ARunIsAsLongAndAsFastAsItIs) {
  for (const double rate : {5.0, 25.0, 100.0}) {
    const auto result = measure(one_person(rate, 10, running, 0));
    ASSERT_EQ(result.people.size(), 1u);
    const PersonMeasure& person = result.people[0];
    EXPECT_NEAR(person.distance_m, 40, 0.05) << rate;
    EXPECT_NEAR(person.mean_mps, 4, 0.01);
    EXPECT_NEAR(person.top_mps, 4, 0.02);
    EXPECT_NEAR(person.average_place.x(), 40, 0.1);
    EXPECT_EQ(person.sprints, 0);
  }
}

TEST(Measure, NoiseDoesNotMakeAnyoneRunFurther) {
  MeasureOptions raw;
  raw.path.method = PathOptions::Method::raw;
  const auto noisy = one_person(25, 60, [](double t) { return Vector<2>(50 + 20 * std::sin(t / 8), 30); }, 0.1);
  double truth = 0;
  for (double t = 0; t < 60; t += 0.001) truth += 20 * std::abs(std::sin((t + 0.001) / 8) - std::sin(t / 8));
  EXPECT_GT(measure(noisy, raw).people[0].distance_m, 1.4 * truth) << "as measured it is far too long";
  for (const auto method : {PathOptions::Method::lowpass, PathOptions::Method::kalman, PathOptions::Method::savgol}) {
    MeasureOptions options;
    options.path.method = method;
    EXPECT_NEAR(measure(noisy, options).people[0].distance_m, truth, 0.06 * truth) << static_cast<int>(method);
  }
}

TEST(Measure, SprintsNeedSpeedAndTime) {
  // 8 m/s from second 2 to second 5, and for half a second only from second 8 on.
  const auto speed = [](double t) { return (t >= 2 && t < 5) || (t >= 8 && t < 8.5) ? 8.0 : 2.0; };
  double x = 0, last = 0;
  const auto place = [&](double t) {
    for (; last < t; last += 0.001) x += 0.001 * speed(last);
    return Vector<2>(x, 10);
  };
  MeasureOptions options;
  options.path.method = PathOptions::Method::raw;
  const auto result = measure(one_person(50, 12, place, 0), options);
  EXPECT_EQ(result.people[0].sprints, 1);
  EXPECT_NEAR(result.people[0].zone_s.back(), 3.5, 0.1);
  EXPECT_NEAR(result.people[0].zone_m.back(), 28, 1);
}

TEST(Measure, LowPassLeavesSlowMotionAloneAndDoesNotLag) {
  for (const double hertz : {0.1, 1.0, 5.0}) {
    std::vector<TimedPlace> measured;
    for (int i = 0; i < 2000; ++i) measured.push_back({i / 50.0, {std::sin(2 * M_PI * hertz * i / 50.0), 0}});
    const Path path = smooth_paths(measured)[0];
    double in_phase = 0, across = 0;
    for (int i = 500; i < 1500; ++i) {
      const double angle = 2 * M_PI * hertz * i / 50.0;
      in_phase += path.place[i].x() * std::sin(angle) / 500;
      across += path.place[i].x() * std::cos(angle) / 500;
    }
    EXPECT_NEAR(across, 0, 0.01) << "nothing lags at " << hertz << " Hz";
    if (hertz < 0.5) {
      EXPECT_NEAR(in_phase, 1, 0.01);
    }
    if (hertz == 1) {
      EXPECT_NEAR(in_phase, std::sqrt(0.5), 0.03) << "half of the power at the cut-off";
    }
    if (hertz > 2) {
      EXPECT_LT(in_phase, 0.01);
    }
  }
}

TEST(Measure, WaysAreCutAtLongGapsAndNobodyIsNoError) {
  std::vector<TimedPlace> measured = {{0, {0, 0}}, {0.1, {1, 0}}, {5, {50, 0}}, {5.1, {51, 0}}, {9, {0, 0}}};
  const auto paths = smooth_paths(measured);
  ASSERT_EQ(paths.size(), 2u) << "a lone place is no way";
  EXPECT_TRUE(measure({}).people.empty());
  GroundRecording still;
  still.people = {{1, "", ""}};
  still.samples = {{0, 0, 0.0, {1, 1}, {0, 0}, 0, true}};
  EXPECT_TRUE(measure(still).people.empty()) << "one place is no way";
}

TEST(Measure, TeamsHaveALengthAWidthAndAHull) {
  GroundRecording recording;
  const std::vector<Vector<2>> places = {{10, 10}, {30, 10}, {30, 40}, {10, 40}, {20, 25}};
  for (int i = 0; i < 5; ++i) recording.people.push_back({i + 1, "", "blue"});
  for (int frame = 0; frame < 3; ++frame) {
    for (int i = 0; i < 5; ++i) recording.samples.push_back({frame, i, frame * 0.04, places[i], {0, 0}, 0, true});
  }
  const auto result = measure(recording);
  ASSERT_EQ(result.teams.size(), 1u);
  EXPECT_NEAR(result.teams[0].length_m, 20, 1e-9);
  EXPECT_NEAR(result.teams[0].width_m, 30, 1e-9);
  EXPECT_NEAR(result.teams[0].hull_m2, 600, 1e-9);
  EXPECT_EQ(result.teams[0].people, 5);
}

}  // namespace
}  // namespace marey::analyse
