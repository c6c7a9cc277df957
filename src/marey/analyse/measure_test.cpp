#include "marey/analyse/measure.h"

#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "marey/core/error.h"

namespace marey::analyse {
namespace {

RecordingHeader on_the_ground() {
  RecordingHeader header;
  header.name = "match.csv";
  header.frame.kind = FrameOfReference::Kind::user_ground;
  header.rate_hz = 25;
  return header;
}

Sample sample_at(int track, const Vector<2>& location) {
  Sample sample;
  sample.track = TrackId{track};
  sample.position.head<2>() = location;
  return sample;
}

Recording one_person(double rate, double seconds, const std::function<Vector<2>(double)>& location, double noise) {
  Recording recording(on_the_ground());
  recording.set_name({TrackId{7}, "seven", "white"});
  std::mt19937 random(5);
  std::normal_distribution<double> off;
  for (int i = 0; i <= rate * seconds; ++i) {
    Instant instant;
    instant.index = i;
    instant.time = timestamp_from_seconds(i / rate);
    const double dx = off(random), dy = off(random);
    instant.samples = {sample_at(7, location(i / rate) + noise * Vector<2>(dx, dy))};
    recording.add(instant);
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
    EXPECT_NEAR(person.top_mps.value(), 4, 0.02);
    EXPECT_NEAR(person.average_position.x(), 40, 0.1);
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
  // 8 m/s from second 2 to second 5, and for half a second only from second 8 on; 5 m/s² to there and back to 2 m/s.
  const auto speed = [](double t) {
    const auto above = [&](double from, double to) { return 6 - 5 * std::max({from - t, t - to, 0.0}); };
    return 2 + std::max({above(2, 5), above(8, 8.5), 0.0});
  };
  double x = 0, last = 0;
  const auto location = [&](double t) {
    for (; last < t; last += 0.001) x += 0.001 * speed(last);
    return Vector<2>(x, 10);
  };
  MeasureOptions options;
  options.path.method = PathOptions::Method::raw;
  const auto result = measure(one_person(50, 12, location, 0), options);
  EXPECT_EQ(result.people[0].sprints, 1);
  EXPECT_NEAR(result.people[0].zone_s.back(), 3.5 + 4 * 0.2, 0.15);
  EXPECT_NEAR(result.people[0].zone_m.back(), 28 + 4 * 0.2 * 7.5, 1.2);
}

TEST(Measure, LowPassLeavesSlowMotionAloneAndDoesNotLag) {
  for (const double hertz : {0.1, 1.0, 5.0}) {
    std::vector<double> times, x;
    for (int i = 0; i < 2000; ++i) times.push_back(i / 50.0), x.push_back(std::sin(2 * M_PI * hertz * i / 50.0));
    const Path path = smooth_paths(times, x, std::vector<double>(2000, 0.0))[0];
    double in_phase = 0, across = 0;
    for (int i = 500; i < 1500; ++i) {
      const double angle = 2 * M_PI * hertz * i / 50.0;
      in_phase += path.location[i].x() * std::sin(angle) / 500;
      across += path.location[i].x() * std::cos(angle) / 500;
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

TEST(Measure, PathsAreCutAtLongGapsAndNobodyIsNoError) {
  const std::vector<double> times = {0, 0.1, 5, 5.1, 5.1, 9}, x = {0, 1, 50, 51, 70, 0}, y(6, 0.0);
  const auto paths = smooth_paths(times, x, y, {.method = PathOptions::Method::raw});
  ASSERT_EQ(paths.size(), 2u) << "a lone place is not a path";
  EXPECT_EQ(paths[1].location.back().x(), 51) << "of two rows at one time the first counts";
  EXPECT_TRUE(measure(Recording(on_the_ground())).people.empty());
  Recording still(on_the_ground());
  Instant lone;
  lone.samples = {sample_at(1, {1, 1})};
  still.add(lone);
  EXPECT_TRUE(measure(still).people.empty()) << "one place is not a path";
}

/// Runs at 6 m/s; the velocities recorded are off on purpose, so that one sees whose are taken.
Recording with_velocities(bool smoothed) {
  Recording recording(on_the_ground());
  recording.header.smoothed = smoothed;
  for (int i = 0; i < 250; ++i) {
    Sample sample = sample_at(3, {0.24 * i, 20});
    sample.velocity = Vector<3>(i == 100 ? 6.75 : 6.5, 0, 0);
    Instant instant;
    instant.index = i;
    instant.time = timestamp_from_seconds(i / 25.0);
    instant.samples = {sample};
    recording.add(instant);
  }
  return recording;
}

TEST(Measure, ASmoothedRunHasOneSpeed) {
  const PersonMeasure recorded = measure(with_velocities(true)).people.at(0);
  EXPECT_NEAR(recorded.top_mps.value(), 6.75, 1e-9) << "the recording's own";
  ASSERT_EQ(recorded.paths.size(), 1u);
  ASSERT_EQ(recorded.paths[0].location.size(), 250u);
  for (std::size_t i = 0; i < 250; ++i) {
    EXPECT_NEAR(recorded.paths[0].velocity[i].x(), i == 100 ? 6.75 : 6.5, 1e-9) << i;
    EXPECT_NEAR(recorded.paths[0].location[i].x(), 0.24 * static_cast<double>(i), 1e-9) << "not smoothed again";
  }
  MeasureOptions other;
  other.path.method = PathOptions::Method::kalman;
  EXPECT_EQ(measure(with_velocities(true), other).people.at(0).top_mps, recorded.top_mps) << "whatever smoother is asked for";
  EXPECT_NEAR(measure(with_velocities(false)).people.at(0).top_mps.value(), 6, 0.05) << "of positions that were not smoothed";
}

TEST(Measure, ASmoothedRunWithoutVelocitiesHasThoseOfItsPlaces) {
  Recording recording = one_person(25, 10, running, 0);
  recording.header.smoothed = true;
  EXPECT_NEAR(measure(recording).people.at(0).top_mps.value(), 4, 1e-6);
}

/// Strolls at 1.5 m/s; from second 4 to second 5.6 no person sees him, and the one who followed him has him dash 10 m to the side
/// and back.
Recording with_a_predicted_dash(bool smoothed) {
  Recording recording(on_the_ground());
  recording.header.smoothed = smoothed;
  for (int i = 0; i <= 250; ++i) {
    const double t = i / 25.0, s = std::clamp((t - 4) / 1.6, 0.0, 1.0);
    Sample sample = sample_at(3, {1.5 * t, 10 + 5 * (1 - std::cos(2 * M_PI * s))});
    sample.velocity = Vector<3>(1.5, 5 * 2 * M_PI / 1.6 * std::sin(2 * M_PI * s), 0);
    if (s > 0 && s < 1) sample.provenance = i % 2 == 0 ? Provenance::predicted : Provenance::filled;
    Instant instant;
    instant.index = i;
    instant.time = timestamp_from_seconds(t);
    instant.samples = {sample};
    recording.add(instant);
  }
  return recording;
}

TEST(Measure, SpeedsAreOfWhatWasMeasured) {
  for (const bool smoothed : {false, true}) {
    const PersonMeasure person = measure(with_a_predicted_dash(smoothed)).people.at(0);
    EXPECT_LT(person.top_mps.value_or(0), 4) << (smoothed ? "smoothed" : "not smoothed");
    EXPECT_EQ(person.sprints, 0);
    EXPECT_NEAR(person.observed_s, 8.4, 0.5);
    EXPECT_NEAR(person.seconds, 10, 0.05);
    EXPECT_NEAR(person.zone_s.back(), 0, 1e-9);
    EXPECT_TRUE(person.impossible.empty()) << "what was not measured is not evidence";
  }
}

TEST(Measure, ATopSpeedBelowTheMeanIsNone) {
  // Walks for two seconds, seen, and runs for eight, of which only the end is seen.
  Recording recording(on_the_ground());
  for (int i = 0; i <= 250; ++i) {
    const double t = i / 25.0;
    Sample sample = sample_at(3, {t < 2 ? t : 2 + 5 * (t - 2), 10});
    if (t > 2 && i < 249) sample.provenance = Provenance::predicted;
    Instant instant;
    instant.index = i;
    instant.time = timestamp_from_seconds(t);
    instant.samples = {sample};
    recording.add(instant);
  }
  const PersonMeasure person = measure(recording).people.at(0);
  ASSERT_GT(person.mean_mps, 3);
  EXPECT_FALSE(person.top_mps.has_value()) << *person.top_mps;
  EXPECT_FALSE(person.top_sigma_mps.has_value());
}

TEST(Measure, UnmeasuredPersonHasNoRow) {
  Recording recording = one_person(25, 4, running, 0);
  for (int i = 0; i < 50; ++i) {
    Sample sample = sample_at(9, {0.3 * i, 20});
    sample.provenance = Provenance::predicted;
    TrackColumns ghost({TrackId{9}, "", ""}, 2);
    if (recording.find(TrackId{9}) != nullptr) ghost = *recording.find(TrackId{9});
    ghost.add(i, sample);
    recording.put(std::move(ghost));
  }
  const auto people = measure(recording).people;
  ASSERT_EQ(people.size(), 1u);
  EXPECT_EQ(people[0].id, 7);
}

/// Walks at 1.5 m/s; at second 5 the places go over to a person who walks 3 m beside him, within a third of a second.
Vector<2> slid(double t) {
  return {1.5 * t, 20 + 3 * std::clamp((t - 5) / 0.33, 0.0, 1.0)};
}

TEST(Measure, ExcludesAndReportsImpossibleMotion) {
  const PersonMeasure person = measure(one_person(25, 10, slid, 0.05)).people.at(0);
  ASSERT_EQ(person.impossible.size(), 1u);
  EXPECT_NEAR(person.impossible[0].begin_s, 5, 0.4);
  EXPECT_NEAR(person.impossible[0].end_s, 5.33, 0.4);
  EXPECT_FALSE(person.impossible[0].one_person);
  EXPECT_LT(person.top_mps.value(), 3);
  EXPECT_EQ(person.paths.size(), 2u) << "another person's path begins";
  EXPECT_TRUE(measure(one_person(25, 10, running, 0.1)).people.at(0).impossible.empty());
}

TEST(Measure, ATopSpeedSaysHowSureItIs) {
  // 60 people at a known speed: two deviations hold the truth nearly always, and are not absurdly wide.
  int held = 0;
  double widest = 0;
  for (int seed = 0; seed < 60; ++seed) {
    Recording recording(on_the_ground());
    std::mt19937 random(static_cast<unsigned>(seed));
    std::normal_distribution<double> off;
    const Matrix<2> P = 0.2 * 0.2 * Matrix<2>::Identity();
    for (int i = 0; i <= 250; ++i) {
      const double dx = 0.2 * off(random), dy = 0.2 * off(random);
      Sample sample = sample_at(1, Vector<2>(0.2 * i + dx, 10 + dy));
      sample.covariance.emplace(Matrix<3>::Zero()).topLeftCorner<2, 2>() = P;
      Instant instant;
      instant.index = i;
      instant.time = timestamp_from_seconds(i / 25.0);
      instant.samples = {sample};
      recording.add(instant);
    }
    const PersonMeasure person = measure(recording).people.at(0);
    held += std::abs(person.top_mps.value() - 5) < 2 * person.top_sigma_mps.value() ? 1 : 0;
    widest = std::max(widest, person.top_sigma_mps.value());
  }
  EXPECT_GE(held, 57);
  EXPECT_LT(widest, 1);
}

TEST(Measure, PixelsAndSpaceAreRefused) {
  for (const auto kind : {FrameOfReference::Kind::image, FrameOfReference::Kind::space}) {
    RecordingHeader header = on_the_ground();
    header.frame.kind = kind;
    try {
      measure(Recording(header));
      ADD_FAILURE() << "measured " << to_string(header.frame);
    } catch (const Error& error) {
      const std::string message_text = error.what();
      EXPECT_NE(message_text.find("match.csv"), std::string::npos) << message_text;
      EXPECT_NE(message_text.find(to_string(header.frame)), std::string::npos) << message_text;
    }
  }
}

TEST(Measure, TeamsHaveALengthAWidthAndAHull) {
  Recording recording(on_the_ground());
  const std::vector<Vector<2>> locations = {{10, 10}, {30, 10}, {30, 40}, {10, 40}, {20, 25}};
  for (int frame = 0; frame < 3; ++frame) {
    Instant instant;
    instant.index = frame;
    instant.time = timestamp_from_seconds(frame * 0.04);
    for (int i = 0; i < 5; ++i) {
      if (frame == 0) instant.named.push_back({TrackId{i + 1}, "", "blue"});
      instant.samples.push_back(sample_at(i + 1, locations[static_cast<std::size_t>(i)]));
    }
    recording.add(instant);
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
