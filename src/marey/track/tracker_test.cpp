#include "marey/track/tracker.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "marey/core/error.h"

namespace marey::track {
namespace {

constexpr double frame_rate = 10;  // Hz
constexpr double tall = 80;        // px

using Detected = std::vector<Observation<2>>;

Observation<2> person(double x, double y, double score = 0.9, double width = 0.4 * tall, double height = tall) {
  Observation<2> observation;
  observation.box = Box::from_centre({x, y}, width, height);
  observation.value = {x, y};
  observation.score = score;
  return observation;
}

/// Runs a scene of `frames` frames and hands each frame's tracks to `look`.
void run(int frames, const std::function<Detected(int)>& scene, const std::function<void(int, std::span<const Track<2>>)>& inspect,
         const TrackerOptions& options = {}) {
  const auto tracker = make_tracker(options);
  for (int frame = 0; frame < frames; ++frame)
    inspect(frame, tracker->step(timestamp_from_seconds(frame / frame_rate), scene(frame)));
}

/// The confirmed track nearest to a place, if any lies within half a body.
std::optional<TrackId> id_at(std::span<const Track<2>> tracks, double x, double y) {
  std::optional<TrackId> id;
  double nearest = tall / 2;
  for (const Track<2>& track : tracks) {
    const double distance = (track.position - Vector<2>(x, y)).norm();
    if (!track.confirmed || distance >= nearest) continue;
    nearest = distance;
    id = track.id;
  }
  return id;
}

TEST(Tracker, TwoThatCrossKeepTheirIdentities) {
  std::optional<TrackId> left, right;
  run(
      60, [](int k) { return Detected{person(100 + 6.0 * k, 200), person(460 - 6.0 * k, 212)}; },
      [&](int k, std::span<const Track<2>> tracks) {
        if (k == 10) {
          left = id_at(tracks, 160, 200);
          right = id_at(tracks, 400, 212);
        }
        if (k != 59) return;
        EXPECT_EQ(id_at(tracks, 454, 200), left);
        EXPECT_EQ(id_at(tracks, 106, 212), right);
      });
  EXPECT_TRUE(left && right);
  EXPECT_NE(left, right);
}

/// A jump of place and shape at once is too much for the gate, yet no other can stand on the very spot.
TEST(Tracker, ATargetThatStepsAsideAtOnceKeepsItsIdentity) {
  const auto scene = [](int k) {
    return Detected{k < 20 ? person(100 + 2.0 * k, 200) : person(86 + 2.0 * k, 196, 0.9, 0.3 * tall, 1.15 * tall)};
  };
  std::set<int> names;
  run(40, scene, [&](int k, std::span<const Track<2>> tracks) {
    if (k < 10) return;
    ASSERT_EQ(tracks.size(), 1u) << k;
    names.insert(number(tracks.front().id));
  });
  EXPECT_EQ(names.size(), 1u);
}

/// Two that meet are seen as one wide region for a second and part again.
TEST(Tracker, TwoThatMergeIntoOneRegionComeOutAsThemselves) {
  const auto location = [](int k, int identity) { return identity == 0 ? 100 + 6.0 * k : 400 - 6.0 * k; };
  const auto scene = [&](int k) {
    const double a = location(k, 0);
    const double b = location(k, 1);
    if (std::abs(a - b) > 32) return Detected{person(a, 200), person(b, 200)};
    return Detected{person((a + b) / 2, 200, 0.9, 32 + std::abs(a - b), tall)};
  };
  std::optional<TrackId> left, right;
  run(50, scene, [&](int k, std::span<const Track<2>> tracks) {
    if (k == 15) {
      left = id_at(tracks, location(k, 0), 200);
      right = id_at(tracks, location(k, 1), 200);
    }
    for (const Track<2>& track : tracks) EXPECT_LT(track.box->width, 45) << "frame " << k << ": a box swallowed a neighbour";
    if (k != 45) return;
    EXPECT_EQ(id_at(tracks, location(k, 0), 200), left);
    EXPECT_EQ(id_at(tracks, location(k, 1), 200), right);
  });
  EXPECT_TRUE(left && right);
  EXPECT_NE(left, right);
}

TEST(Tracker, ASharedRegionGivesPlaceNotSize) {
  run(
      40,
      [](int k) {
        Detected detected{person(100 + 3.0 * k, 200)};
        if (k >= 20) {
          detected[0] = person(100 + 3.0 * k, 200, 0.9, 0.4 * tall * 1.2, tall * 1.2);
          detected[0].shared = true;
        }
        return detected;
      },
      [](int k, std::span<const Track<2>> tracks) {
        ASSERT_EQ(tracks.size(), 1U) << k;
        EXPECT_NEAR(tracks[0].box->height, tall, 1e-6);
        EXPECT_NEAR(tracks[0].position.x(), 100 + 3.0 * k, 8);
      });
}

TEST(Tracker, AShortOcclusionIsBridgedByPrediction) {
  std::set<int> names;
  run(
      40, [](int k) { return k >= 20 && k < 27 ? Detected{} : Detected{person(100 + 5.0 * k, 200)}; },
      [&](int k, std::span<const Track<2>> tracks) {
        ASSERT_EQ(tracks.size(), 1U) << "frame " << k;
        names.insert(number(tracks[0].id));
        const bool hidden = k >= 20 && k < 27;
        EXPECT_EQ(tracks[0].provenance, hidden ? Provenance::predicted : Provenance::measured);
        EXPECT_NEAR(tracks[0].position.x(), 100 + 5.0 * k, 12);
      });
  EXPECT_EQ(names.size(), 1U);
}

TEST(Tracker, BirthTakesEvidenceAndDeathTheLackOfIt) {
  bool confirmed_at_once = false;
  int last_alive = 0;
  run(
      80, [](int k) { return k < 20 ? Detected{person(200, 200)} : Detected{}; },
      [&](int k, std::span<const Track<2>> tracks) {
        if (k == 0) confirmed_at_once = tracks[0].confirmed;
        if (k == 5) {
          EXPECT_TRUE(tracks[0].confirmed);
        }
        if (!tracks.empty()) last_alive = k;
      });
  EXPECT_FALSE(confirmed_at_once);
  EXPECT_GT(last_alive, 22);
  EXPECT_LT(last_alive, 20 + frame_rate * TrackerOptions{}.patience + 1);
}

TEST(Tracker, NoTargetJumpsFasterThanTheLimit) {
  std::optional<TrackId> before, after;
  const double step = 1.5 * TrackerOptions{}.max_speed * tall / frame_rate;  // px a frame
  run(
      20, [&](int k) { return Detected{person(k < 10 ? 100 : 100 + step * 3, 200)}; },
      [&](int k, std::span<const Track<2>> tracks) {
        if (k == 9) before = id_at(tracks, 100, 200);
        if (k == 19) after = id_at(tracks, 100 + step * 3, 200);
      });
  ASSERT_TRUE(before && after) << "both are followed";
  EXPECT_NE(before, after);
}

TEST(Tracker, WeakObservationsContinueButDoNotBegin) {
  std::set<int> names;
  run(
      30, [](int k) { return Detected{person(100 + 4.0 * k, 200, k < 8 ? 0.9 : 0.2), person(400, 200, 0.3)}; },
      [&](int, std::span<const Track<2>> tracks) {
        for (const Track<2>& track : tracks) names.insert(number(track.id));
        ASSERT_EQ(tracks.size(), 1U);
        EXPECT_EQ(tracks[0].provenance, Provenance::measured);
      });
  EXPECT_EQ(names.size(), 1U);
}

TEST(Tracker, ADoubleBoxIsOnePerson) {
  run(
      20, [](int k) { return Detected{person(100 + 4.0 * k, 200), person(101 + 4.0 * k, 201, 0.8)}; },
      [](int, std::span<const Track<2>> tracks) { EXPECT_EQ(tracks.size(), 1U); });
}

TEST(Tracker, ACameraThatTurnsTakesAllTargetsAlong) {
  constexpr int kPeople = 5;
  std::map<int, std::set<TrackId>> ids;
  const auto pan = [](int k) { return k < 15 ? 0.0 : 35.0 * (k - 14); };
  run(
      30,
      [&](int k) {
        Detected detected;
        for (int i = 0; i < kPeople; ++i) detected.push_back(person(100 + 120.0 * i + 2.0 * k + pan(k), 200 + 10.0 * i));
        return detected;
      },
      [&](int k, std::span<const Track<2>> tracks) {
        if (k < 10) return;
        for (int i = 0; i < kPeople; ++i) {
          const auto id = id_at(tracks, 100 + 120.0 * i + 2.0 * k + pan(k), 200 + 10.0 * i);
          ASSERT_TRUE(id) << "person " << i << " is lost in frame " << k;
          ids[i].insert(*id);
        }
      });
  std::set<TrackId> all;
  for (const auto& [person, own] : ids) {
    EXPECT_EQ(own.size(), 1U) << "person " << person;
    all.insert(own.begin(), own.end());
  }
  EXPECT_EQ(all.size(), static_cast<std::size_t>(kPeople)) << "no two share an identity";
}

Detected noisy_crowd(std::mt19937& random, int k) {
  std::normal_distribution<double> noise(0, 3);
  std::uniform_real_distribution<double> unit(0, 1);
  Detected detected;
  for (int identity = 0; identity < 12; ++identity) {
    if (unit(random) < 0.2) continue;
    const double x = 60.0 * identity + (identity % 2 == 0 ? 4.0 : -4.0) * k;
    detected.push_back(person(x + noise(random), 200 + 25.0 * (identity % 4) + noise(random), 0.3 + 0.7 * unit(random)));
  }
  return detected;
}

TEST(Tracker, TheSameInputGivesTheSameBits) {
  const auto once = [] {
    std::mt19937 random(8);
    std::vector<double> all;
    run(
        100, [&](int k) { return noisy_crowd(random, k); },
        [&](int, std::span<const Track<2>> tracks) {
          for (const Track<2>& track : tracks) {
            all.insert(all.end(), {static_cast<double>(number(track.id)), track.position.x(), track.position.y(),
                                   track.velocity.x(), track.box->height});
          }
        });
    return all;
  };
  EXPECT_EQ(once(), once());
}

TEST(Tracker, TheOrderOfObservationsDoesNotMatter) {
  std::mt19937 random(9);
  const auto forward = make_tracker({});
  const auto backward = make_tracker({});
  for (int k = 0; k < 60; ++k) {
    Detected detected = noisy_crowd(random, k);
    const auto a = forward->step(timestamp_from_seconds(k / frame_rate), detected);
    std::reverse(detected.begin(), detected.end());
    const auto b = backward->step(timestamp_from_seconds(k / frame_rate), detected);
    ASSERT_EQ(a.size(), b.size()) << k;
    const auto location = [](const Track<2>& track) { return std::pair(track.position.x(), track.position.y()); };
    std::set<std::pair<double, double>> places_a, places_b;
    for (const auto& track : a) places_a.insert(location(track));
    for (const auto& track : b) places_b.insert(location(track));
    EXPECT_EQ(places_a, places_b) << k;
  }
}

TEST(Tracker, HostileInputGivesNoNaN) {
  const auto tracker = make_tracker({});
  std::mt19937 random(3);
  std::uniform_real_distribution<double> exponent(-6, 8);
  double now = 0;
  for (int k = 0; k < 300; ++k) {
    now += k % 50 == 49 ? 86400 : 1e-6 + (k % 7) * 0.05;
    Detected detected;
    for (unsigned i = 0; i < random() % 6; ++i) {
      const double size = std::pow(10, exponent(random));
      detected.push_back(person(std::pow(10, exponent(random)), -std::pow(10, exponent(random)), 1, size, size * 2));
    }
    if (k % 5 == 0) detected.push_back(person(10, 10, 1, 0, 0));
    for (const Track<2>& track : tracker->step(timestamp_from_seconds(now), detected)) {
      ASSERT_TRUE(track.position.allFinite() && track.velocity.allFinite() && track.covariance.allFinite()) << k;
    }
  }
}

TEST(Tracker, RefusesTimesThatDoNotGrowAndNumbersThatAreNone) {
  const auto tracker = make_tracker({});
  tracker->step(timestamp_from_seconds(1), Detected{});
  EXPECT_THROW(tracker->step(timestamp_from_seconds(1), Detected{}), Error);
  EXPECT_THROW(tracker->step(timestamp_from_seconds(0.5), Detected{}), Error);
  const Detected broken{person(std::nan(""), 2)};
  EXPECT_THROW(tracker->step(timestamp_from_seconds(2), broken), Error);
}

TEST(Tracker, RefusesOptionsOutOfTheirDomain) {
  EXPECT_THROW(make_tracker({.gate_probability = 1}), Error);
  EXPECT_THROW(make_tracker({.max_speed = 0}), Error);
  EXPECT_THROW(make_tracker({.position_noise = -1}), Error);
}

TEST(Tracker, EveryFilterFollowsPoints) {
  for (const filter::NamedFilter& filter : filter::named_filters()) {
    TrackerOptions options = point_tracker_options();
    options.filter = filter.options;
    const auto tracker = make_tracker(options);
    std::set<int> names;
    for (int k = 0; k < 40; ++k) {
      Detected detected(2);
      detected[0].value = {100.0 + 2 * k, 50};
      detected[1].value = {300.0 - 2 * k, 150};
      const auto tracks = tracker->step(timestamp_from_seconds(k / 60.0), detected);
      for (const auto& track : tracks) names.insert(number(track.id));
      EXPECT_EQ(tracks.size(), 2U) << filter.name << ", frame " << k;
    }
    EXPECT_EQ(names.size(), 2U) << filter.name;
  }
}

TEST(Tracker, SaysWhichTrackEachObservationBelongsTo) {
  const auto tracker = make_tracker({});
  for (int k = 0; k < 5; ++k) {
    const Detected detected{person(400 - 3.0 * k, 200), person(100 + 3.0 * k, 200)};
    const auto tracks = tracker->step(timestamp_from_seconds(k / frame_rate), detected);
    ASSERT_EQ(tracker->matches().size(), 2U);
    for (const ObservationMatch& match : tracker->matches()) {
      EXPECT_EQ(match.view, 0);
      for (const Track<2>& track : tracks) {
        if (track.id == match.track) {
          EXPECT_NEAR(track.position.x(), detected[match.observation].value.x(), 5);
        }
      }
    }
    ASSERT_EQ(tracker->decided().size(), 1U);
    EXPECT_EQ(tracker->decided()[0].tracks.size(), 2U);
  }
  EXPECT_TRUE(tracker->decide_all().empty());
}

}  // namespace
}  // namespace marey::track
