#include "marey/track/ground/mht/ground_mht.h"

#include <algorithm>
#include <random>
#include <set>
#include <tuple>

#include <gtest/gtest.h>
#include <malloc.h>

#include "marey/track/ground/ground_presence.h"
#include "marey/track/ground/ground_scene_test.h"
#include "marey/track/ground/ground_target.h"

namespace marey::track::ground::mht {
namespace {

using namespace ground_scene;
using Detected = std::vector<Observation<2>>;

Observation<2> at(const Vector<2>& location, double sigma = 0.2) {
  Observation<2> one;
  one.value = location;
  one.covariance = sigma * sigma * Matrix<2>::Identity();
  one.score = 0.9;
  return one;
}

Timestamp instant(int frame) {
  return timestamp_from_seconds(frame / rate);
}

std::span<const Track<2>> step(GroundTracker& tracker, int frame, const Detected& detected) {
  const CameraObservations inspect{CameraId{0}, instant(frame), detected};
  return tracker.step(instant(frame), {&inspect, 1});
}

const GroundView whole = view_of(-500, 500, -500, 500);

/// The slow twin: every hypothesis over all targets, each with its own copies; no clusters, no gates between hypotheses, nothing
/// shared, nothing pruned. One camera that sees everything.
class Enumeration {
 public:
  explicit Enumeration(const GroundTrackerOptions& options) : rules_(options, 1), hypotheses_(1) {}

  void step(int frame, const Detected& detected) {
    const double dt = frame == 0 ? 1.0 : 1 / rate;
    const double births = rules_.options().births * dt;
    std::vector<Hypothesis> children;
    for (Hypothesis& parent : hypotheses_) {
      for (Person& person : parent.people) {
        rules_.predict(person.target, frame == 0 ? 0.0 : dt);
      }
      std::vector<int> owners(detected.size(), -1);
      spread(parent, detected, instant(frame), births, 0, owners, children);
    }
    for (Hypothesis& one : children) {
      std::erase_if(one.people, [&](const Person& person) { return rules_.lost(person.target, instant(frame)); });
    }
    hypotheses_ = std::move(children);
  }

  std::vector<Vector<2>> best() const {
    const auto maximum = std::max_element(hypotheses_.begin(), hypotheses_.end(),
                                          [](const Hypothesis& a, const Hypothesis& b) { return a.weight < b.weight; });
    std::vector<Vector<2>> locations;
    for (const Person& person : maximum->people) locations.push_back(person.target.filter.position());
    return locations;
  }

  std::size_t size() const { return hypotheses_.size(); }

 private:
  struct Person {
    GroundTarget target;
  };
  struct Hypothesis {
    double weight = 0;
    std::vector<Person> people;
  };

  /// Gives observation `index` and those after it to no person known, or to each person who has none yet.
  void spread(const Hypothesis& parent, const Detected& detected, Timestamp now, double births, std::size_t index,
              std::vector<int>& owners, std::vector<Hypothesis>& children) {
    if (index < detected.size()) {
      for (int person = -1; person < static_cast<int>(parent.people.size()); ++person) {
        if (person >= 0 && std::find(owners.begin(), owners.end(), person) != owners.end()) continue;
        if (person >= 0 && !merit(parent.people[person], detected[index], now)) continue;
        owners[index] = person;
        spread(parent, detected, now, births, index + 1, owners, children);
        owners[index] = -1;
      }
      return;
    }
    Hypothesis child = parent;
    for (std::size_t i = 0; i < parent.people.size(); ++i) {
      const auto found = std::find(owners.begin(), owners.end(), static_cast<int>(i));
      Person& person = child.people[i];
      if (found == owners.end()) {
        child.weight += std::log(1 - person.target.presence.visible() * rules_.options().detected);
        rules_.miss(person.target, 1);
      } else {
        const Observation<2>& one = detected[found - owners.begin()];
        child.weight += *merit(parent.people[i], one, now) + std::log(parent.people[i].target.presence.visible());
        rules_.correct(person.target, one, rules_.at_instant(person.target, one, 0), now);
      }
    }
    for (std::size_t o = 0; o < detected.size(); ++o) {
      if (owners[o] >= 0) continue;
      child.weight += std::log((births + rules_.options().clutter) / rules_.options().clutter);
      child.people.push_back({rules_.start(TrackId{1}, now, detected[o])});
      child.people.back().target.presence = GroundPresence(births, rules_.options().clutter);
    }
    children.push_back(std::move(child));
  }

  std::optional<double> merit(const Person& person, const Observation<2>& detected, Timestamp now) const {
    return rules_.log_ratio(person.target, detected, rules_.at_instant(person.target, detected, 0), now);
  }

  GroundRules rules_;
  std::vector<Hypothesis> hypotheses_;
};

std::vector<Vector<2>> sorted(std::vector<Vector<2>> locations) {
  std::sort(locations.begin(), locations.end(),
            [](const auto& a, const auto& b) { return std::tuple(a.x(), a.y()) < std::tuple(b.x(), b.y()); });
  return locations;
}

TEST(GroundMht, WithoutPruningTheBestIsThatOfAllHypotheses) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  Random random(seed);
  std::size_t maximum = 0;
  for (int round = 0; round < 20; ++round) {
    // Few people near each other, and much clutter, so that there is something to choose.
    GroundTrackerOptions options{
        .associate = GroundAssociation::mht, .clutter = 0.01, .births = 0.05, .hypotheses = 1'000'000, .window = 100};
    const auto tracker = make_ground_mht(options, ground_views({whole}),
                                         {.ratio = 1e-300, .leaves = 1'000'000'000, .fold = false, .distrust_shared = false});
    Enumeration twin(options);
    for (int frame = 0; frame < 4; ++frame) {
      Detected detected;
      for (int person = 0; person < 2; ++person) {
        if (!random.chance(0.2)) detected.push_back(at(Vector<2>(0.6 * person, 0) + random.gaussian(0.3), 0.3));
      }
      if (random.chance(0.3)) detected.push_back(at({random.uniform(-2, 2), random.uniform(-2, 2)}));
      twin.step(frame, detected);
      std::vector<Vector<2>> locations;
      for (const Track<2>& track : step(*tracker, frame, detected)) locations.push_back(track.position);
      const auto expected = sorted(twin.best());
      const auto found = sorted(locations);
      ASSERT_EQ(found.size(), expected.size()) << "round " << round << ", frame " << frame;
      for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_LT((found[i] - expected[i]).norm(), 1e-9) << "round " << round << ", frame " << frame;
      }
    }
    maximum = std::max(maximum, twin.size());
  }
  EXPECT_GT(maximum, 100U) << "nothing to choose from";
}

/// Two who run towards each other, at y = 0 and y = `apart`, and are seen as one while they pass.
Detected passing(Random& random, int frame, double apart) {
  const double x = 0.12 * (frame - 50);
  Detected detected;
  if (std::abs(x) < 0.35) {
    detected.push_back(at(Vector<2>(0, apart / 2) + random.gaussian(0.15)));
  } else {
    if (!random.chance(0.1)) detected.push_back(at(Vector<2>(x, 0) + random.gaussian(0.15)));
    if (!random.chance(0.1)) detected.push_back(at(Vector<2>(-x, apart) + random.gaussian(0.15)));
  }
  return detected;
}

TEST(GroundMht, DecidesAfterAMeetingWhoIsWho) {
  int right = 0;
  for (int seed = 1; seed <= 20; ++seed) {
    const auto tracker = make_ground_mht({.associate = GroundAssociation::mht}, ground_views({whole}));
    Random random(static_cast<std::uint64_t>(seed));
    std::vector<std::pair<int, int>> ids;  // of the two, as decided
    const auto take = [&](std::span<const GroundDecision> decisions) {
      for (const GroundDecision& one : decisions) {
        const double x = 0.12 * (static_cast<int>(ids.size()) - 50);
        ids.emplace_back(id_at(one.tracks, {x, 0}), id_at(one.tracks, {-x, 0.3}));
      }
    };
    for (int frame = 0; frame < 100; ++frame) {
      step(*tracker, frame, passing(random, frame, 0.3));
      take(tracker->decided());
    }
    take(tracker->decide_all());
    ASSERT_EQ(ids.size(), 100U);
    EXPECT_NE(ids[30].first, 0);
    EXPECT_NE(ids[30].second, 0);
    right += ids[30] == ids[95] ? 1 : 0;
  }
  EXPECT_GE(right, 19);
}

TEST(GroundMht, TellsEachInstantOnceInOrderAndNotBeforeItsWindow) {
  const auto tracker = make_ground_mht({.associate = GroundAssociation::mht, .window = 0.5}, ground_views({whole}));
  Random random(3);
  int reported = 0;
  for (int frame = 0; frame < 100; ++frame) {
    step(*tracker, frame, passing(random, frame, 0.3));
    for (const GroundDecision& one : tracker->decided()) {
      EXPECT_EQ(one.now, instant(reported++));
      EXPECT_LE(one.now, instant(frame) - duration_from_seconds(0.5));
      EXPECT_TRUE(std::is_sorted(one.tracks.begin(), one.tracks.end(), [](const auto& a, const auto& b) { return a.id < b.id; }));
      for (const ObservationMatch& claim : one.matches) {
        const auto owner = [&](const Track<2>& track) { return track.id == claim.track && track.cameras != 0; };
        EXPECT_EQ(std::count_if(one.tracks.begin(), one.tracks.end(), owner), 1);
      }
    }
  }
  EXPECT_GE(reported, 85);
  for (const GroundDecision& one : tracker->decide_all()) EXPECT_EQ(one.now, instant(reported++));
  EXPECT_EQ(reported, 100);
}

TEST(GroundMht, IsTheSameAgain) {
  const auto run_once = [] {
    const auto tracker = make_ground_mht({.associate = GroundAssociation::mht}, ground_views({whole}));
    Random random(5);
    std::vector<std::tuple<int, int, double, double>> rows;
    for (int frame = 0; frame < 150; ++frame) {
      for (const Track<2>& track : step(*tracker, frame, passing(random, frame % 100, 0.3)))
        rows.emplace_back(frame, number(track.id), track.position.x(), track.position.y());
    }
    return rows;
  };
  EXPECT_EQ(run_once(), run_once());
}

TEST(GroundMht, FollowsOneAndForgetsHim) {
  const auto tracker = make_ground_mht({.associate = GroundAssociation::mht}, ground_views({whole}));
  std::set<int> ids;
  for (int frame = 0; frame < 50; ++frame) {
    const auto tracks = step(*tracker, frame, {at({0.1 * frame, 0})});
    ASSERT_EQ(tracks.size(), 1U);
    ids.insert(number(tracks[0].id));
    ASSERT_EQ(tracker->matches().size(), 1U);
    EXPECT_EQ(tracker->matches()[0].track, tracks[0].id);
  }
  EXPECT_EQ(ids.size(), 1U);
  EXPECT_NEAR(tracker->expected(instant(50))[0].position.x(), 5.0, 0.2);
  for (int frame = 50; frame < 300; ++frame) step(*tracker, frame, {});
  EXPECT_TRUE(step(*tracker, 300, {}).empty());
  EXPECT_TRUE(tracker->matches().empty());
  EXPECT_TRUE(tracker->expected(instant(301)).empty());
}

TEST(GroundMht, NothingSeenAndNoLooksAreNothing) {
  const auto tracker = make_ground_mht({.associate = GroundAssociation::mht}, ground_views({whole}));
  EXPECT_TRUE(tracker->expected(instant(0)).empty());
  EXPECT_TRUE(tracker->decide_all().empty());
  EXPECT_TRUE(tracker->step(instant(0), Detected{}).empty());
  EXPECT_TRUE(step(*tracker, 1, {}).empty());
  EXPECT_EQ(tracker->decide_all().size(), 2U);
}

/// A scuffle of eight people within a few metres, and clutter among them, that never ends.
Detected scuffle(Random& random, int frame) {
  Detected detected;
  for (int person = 0; person < 8; ++person) {
    const double angle = 0.02 * frame * (person % 2 == 0 ? 1 : -1) + person;
    if (!random.chance(0.1)) detected.push_back(at(1.5 * Vector<2>(std::cos(angle), std::sin(angle)) + random.gaussian(0.3), 0.3));
  }
  if (random.chance(0.5)) detected.push_back(at({random.uniform(-5, 5), random.uniform(-5, 5)}));
  return detected;
}

TEST(GroundMht, NeedsNoMoreMemoryHoweverLongAScuffleLasts) {
  const auto tracker =
      make_ground_mht({.associate = GroundAssociation::mht, .hypotheses = 10, .window = 0.5}, ground_views({whole}));
  Random random(11);
  int frame = 0;
  for (; frame < 2000; ++frame) step(*tracker, frame, scuffle(random, frame));
  const std::size_t early = mallinfo2().uordblks;
  for (; frame < 10'000; ++frame) step(*tracker, frame, scuffle(random, frame));
  const std::size_t late = mallinfo2().uordblks;
  EXPECT_LT(late, early + 2'000'000);
}

TEST(GroundMht, ManyFalsePointsDoNotMultiply) {
  const auto tracker = make_ground_mht({.associate = GroundAssociation::mht, .clutter = 0.05}, ground_views({whole}));
  Random random(13);
  std::set<int> ids;
  for (int frame = 0; frame < 60; ++frame) {
    Detected detected;
    if (!random.chance(0.1)) detected.push_back(at(Vector<2>(-20 + 0.15 * frame, 0) + random.gaussian(0.1), 0.1));
    for (int i = 0; i < 350; ++i) detected.push_back(at({random.uniform(-52, 52), random.uniform(-34, 34)}, 0.1));
    step(*tracker, frame, detected);
    for (const GroundDecision& one : tracker->decided()) {
      if (seconds(one.now) > 0.5) ids.insert(id_at(one.tracks, {-20 + 0.15 * rate * seconds(one.now), 0}, 0.6));
    }
  }
  EXPECT_EQ(ids.size(), 1U);
  EXPECT_FALSE(ids.contains(0));
}

}  // namespace
}  // namespace marey::track::ground::mht
