#include "marey/track/roster/roster_tracker.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "marey/core/error.h"

namespace marey::track::roster {
namespace {

using Locations = std::vector<Vector<2>>;

std::vector<Observation<2>> at(const Locations& locations) {
  std::vector<Observation<2>> detected;
  for (const Vector<2>& location : locations) {
    auto& point = detected.emplace_back();
    point.value = location;
    point.covariance = 0.01 * Matrix<2>::Identity();
    point.box = Box::from_centre(location, 10, 10);
  }
  return detected;
}

Timestamp time_at_30_hz(int index) {
  return timestamp_from_seconds(index / 30.0);
}

RosterTrackerOptions with_labels(std::vector<std::string> labels) {
  RosterTrackerOptions options;
  options.labels = std::move(labels);
  return options;
}

Vector<2> position_of(std::span<const Track<2>> tracks, const std::string& label) {
  for (const Track<2>& track : tracks) {
    if (track.label == label) return track.position;
  }
  ADD_FAILURE() << "no person is called " << label;
  return Vector<2>::Zero();
}

TEST(RosterTracker, LabelsGoFromLeftToRightAndInOneColumnFromTheTop) {
  const auto tracker = make_roster_tracker<2>(with_labels({"a", "b", "c"}));
  const auto tracks = tracker->step(time_at_30_hz(0), at({{300, 10}, {50, 90}, {50, 20}}));
  EXPECT_EQ(position_of(tracks, "a"), Vector<2>(50, 20));
  EXPECT_EQ(position_of(tracks, "b"), Vector<2>(50, 90));
  EXPECT_EQ(position_of(tracks, "c"), Vector<2>(300, 10));
}

TEST(RosterTracker, LabelsThatDoNotFitAreRefused) {
  EXPECT_THROW(make_roster_tracker<2>(with_labels({"a", "a"})), Error);
  EXPECT_THROW(make_roster_tracker<2>(with_labels({"a", "b"}))->step(time_at_30_hz(0), at({{1, 1}})), Error);
}

TEST(RosterTracker, TimesMustGrow) {
  const auto tracker = make_roster_tracker<2>({});
  tracker->step(time_at_30_hz(3), at({{1, 1}}));
  EXPECT_THROW(tracker->step(time_at_30_hz(3), at({{1, 1}})), Error);
}

TEST(RosterTracker, AMarkerThatComesBackAfterTwoSecondsHasItsName) {
  const auto tracker = make_roster_tracker<2>(with_labels({"hip", "knee"}));
  for (int i = 0; i < 30; ++i) tracker->step(time_at_30_hz(i), at({{100 + 2.0 * i, 100}, {400, 300}}));
  for (int i = 30; i < 90; ++i) tracker->step(time_at_30_hz(i), at({{400, 300}}));
  std::span<const Track<2>> tracks;
  for (int i = 90; i < 96; ++i) tracks = tracker->step(time_at_30_hz(i), at({{400, 300}, {250 - 2.0 * (i - 90), 180}}));
  EXPECT_NEAR((position_of(tracks, "hip") - Vector<2>(240, 180)).norm(), 0, 1);
  EXPECT_NEAR((position_of(tracks, "knee") - Vector<2>(400, 300)).norm(), 0, 1);
}

TEST(RosterTracker, AMarkerThatVanishesSlowlyBehindAnEdgeGoesOnAsItWent) {
  const auto tracker = make_roster_tracker<2>(with_labels({"wrist"}));
  constexpr double kSpeed = 0.35, kWidth = 10.5;  // px, a frame
  std::span<const Track<2>> tracks;
  double x = 100;
  for (int i = 0; i < 330; ++i, x += kSpeed) {
    const double covered = std::clamp(x + kWidth / 2 - 160, 0.0, kWidth);  // of its width, by an edge at 160
    auto detected = at({{x - covered / 2, 100}});
    // A disc that is cut is a bad disc before it is a small one.
    detected[0].covariance = Matrix<2>::Identity() * std::pow(0.003 + 0.01 * covered, 2);
    detected[0].box = Box::from_centre(detected[0].value, kWidth - covered, kWidth);
    if (covered > 0.9 * kWidth) detected.clear();
    tracks = tracker->step(timestamp_from_seconds(i / 200.0), detected);
  }
  EXPECT_NEAR(position_of(tracks, "wrist").x(), x - kSpeed, 3);
}

TEST(RosterTracker, TwoThatPassThroughEachOtherKeepTheirCourses) {
  const auto tracker = make_roster_tracker<2>(with_labels({"right", "left"}));
  std::span<const Track<2>> tracks;
  for (int i = 0; i <= 60; ++i) {
    const Vector<2> a(100 + 4.0 * i, 200), b(340 - 4.0 * i, 203);
    // While they overlap by more than half, one blob is seen between them.
    const bool merged = (a - b).norm() < 6;
    tracks = tracker->step(time_at_30_hz(i), merged ? at({(a + b) / 2}) : at({a, b}));
  }
  EXPECT_NEAR(position_of(tracks, "right").x(), 340, 1);
  EXPECT_NEAR(position_of(tracks, "left").x(), 100, 1);
}

TEST(RosterTracker, ASharpCornerAtSpeedLosesNobody) {
  const auto tracker = make_roster_tracker<2>(with_labels({"only"}));
  Vector<2> location(100, 100);
  std::span<const Track<2>> tracks;
  for (int i = 0; i < 40; ++i) {
    location += (i / 5) % 2 == 0 ? Vector<2>(25, 10) : Vector<2>(-22, 14);
    tracks = tracker->step(time_at_30_hz(i), at({location}));
    ASSERT_EQ(tracks.size(), 1u);
    ASSERT_TRUE(tracks[0].observation) << "frame " << i;
  }
}

TEST(RosterTracker, KeepsAPredictedMarkerInTheImageAndFromFarDetections) {
  RosterTrackerOptions options;
  options.image = Box{-0.5, -0.5, 640, 480};
  const auto tracker = make_roster_tracker<2>(options);
  std::map<TrackId, Vector<2>> last;
  std::set<TrackId> ids;
  for (int i = 0; i < 120; ++i) {
    Locations locations{{300, 300 + 2.0 * (i % 20 < 10 ? i % 10 : 10 - i % 10)}};
    if (i < 30) locations.emplace_back(400 + 4.0 * i, 100);  // leaves towards the right border, which it would reach at frame 60
    if (i >= 70) locations.emplace_back(60 + 2.0 * (i - 70), 380);  // too far away to be it
    const auto detected = at(locations);
    std::map<TrackId, Vector<2>> now;
    for (const Track<2>& track : tracker->step(time_at_30_hz(i), detected)) {
      if (!track.confirmed) continue;
      ids.insert(track.id);
      now[track.id] = track.position;
      EXPECT_TRUE(track.position.x() > -0.5 && track.position.x() < 639.5) << "frame " << i << ", x " << track.position.x();
      const double step = last.contains(track.id) ? (last[track.id] - track.position).norm() : 0;
      EXPECT_LT(step, 30) << "frame " << i;
    }
    last = std::move(now);
  }
  EXPECT_EQ(ids.size(), 3u) << "two and one that came";
  EXPECT_EQ(last.size(), 2u) << "the one that is gone is not reported permanently";
}

TEST(RosterTracker, BringsBackAMarkerWithoutASize) {
  const auto tracker = make_roster_tracker<2>({});
  std::set<TrackId> ids;
  for (int i = 0; i < 60; ++i) {
    Locations locations{{400, 300}};
    if (i < 20 || i >= 30) locations.emplace_back(100 + 3.0 * std::min(i, 45 - std::min(i, 30)), 100);  // turns back unseen
    auto detected = at(locations);
    for (Observation<2>& point : detected) point.box = Box::from_centre(point.value, 0, 0);
    for (const Track<2>& track : tracker->step(time_at_30_hz(i), detected)) {
      if (track.confirmed && track.observation) ids.insert(track.id);
    }
  }
  EXPECT_EQ(ids.size(), 2u);
}

RosterTrackerOptions in_space() {
  RosterTrackerOptions options;
  options.filter = filter::KalmanOptions{.acceleration_noise = 3, .initial_speed = 1.5};
  options.max_speed = 15;
  options.marker_width = 0.02;
  options.position_noise = 1e-4;
  options.rigid_neighbours = true;
  return options;
}

/// Every motion turns back within one frame, as an impact or images that are played backwards make it.
TEST(RosterTracker, KeepsIdsInSpaceWhenEveryMotionTurnsBack) {
  for (const double rate : {25.0, 60.0, 240.0}) {
    const auto tracker = make_roster_tracker<3>(in_space());
    std::set<TrackId> ids;
    int measured = 0;
    const int turn = static_cast<int>(rate), frames = 4 * turn;
    for (int i = 0; i < frames; ++i) {
      const double t = (i / turn % 2 == 0 ? i % turn : turn - i % turn) / rate;
      std::vector<Observation<3>> detected;
      for (int m = 0; m < 12; ++m) {  // up to 1.1 m/s, each on its own path
        auto& point = detected.emplace_back();
        const double angle = 2.4 * m;
        point.value = Vector<3>(0.4 * (m % 4), 0.4 * (m / 4), 1) + 0.1 * m * t * Vector<3>(std::cos(angle), std::sin(angle), 0.3);
        point.covariance = 1e-8 * Matrix<3>::Identity();
      }
      for (const Track<3>& track : tracker->step(timestamp_from_seconds(i / rate), detected)) {
        if (!track.confirmed || !track.observation) continue;
        ids.insert(track.id);
        ++measured;
      }
    }
    EXPECT_EQ(ids.size(), 12u) << rate << " Hz";
    EXPECT_GT(measured, 0.98 * 12 * frames) << rate << " Hz";
  }
}

TEST(RosterTracker, ALightOfOneFrameIsNotReported) {
  const auto tracker = make_roster_tracker<2>({});
  for (int i = 0; i < 20; ++i) {
    Locations locations{{100 + 3.0 * i, 100}};
    if (i == 8) locations.push_back({500, 400});
    int confirmed = 0;
    for (const Track<2>& track : tracker->step(time_at_30_hz(i), at(locations))) confirmed += track.confirmed ? 1 : 0;
    EXPECT_EQ(confirmed, 1) << "frame " << i;
  }
}

TEST(RosterTracker, TheSameInputGivesTheSameBits) {
  const auto run = [] {
    const auto tracker = make_roster_tracker<2>({});
    Vector<2> last;
    for (int i = 0; i < 50; ++i) {
      for (const Track<2>& track : tracker->step(time_at_30_hz(i), at({{100 + 5.0 * i, 90 + i % 3}, {400 - 4.0 * i, 95}})))
        last = track.position;
    }
    return last;
  };
  EXPECT_EQ(run(), run());
}

TEST(RosterTracker, ExpectedDoesNotMoveAnybody) {
  const auto tracker = make_roster_tracker<2>({});
  for (int i = 0; i < 10; ++i) tracker->step(time_at_30_hz(i), at({{100 + 5.0 * i, 90}}));
  const Vector<2> ahead = tracker->expected(time_at_30_hz(12))[0].position;
  EXPECT_EQ(tracker->expected(time_at_30_hz(12))[0].position, ahead);
  EXPECT_NEAR(ahead.x(), 160, 2);
}

}  // namespace
}  // namespace marey::track::roster
