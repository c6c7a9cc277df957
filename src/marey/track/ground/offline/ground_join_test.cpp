#include "marey/track/ground/offline/ground_join.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "marey/assign/gated_assignment.h"

namespace marey::track::ground::offline {
namespace {

constexpr Appearance white{.lightness = 90, .a = 0, .b = 0, .deviation = 3};
constexpr Appearance blue{.lightness = 35, .a = 15, .b = -50, .deviation = 3};

/// A person who walks straight from `first` to `last`, seen ten times a second.
GroundTracklet walk(int track, double first, double last, const Vector<2>& from, const Vector<2>& velocity,
                    const std::optional<Appearance>& clothing = {}) {
  GroundTracklet tracklet{.runs = {{TrackId{track}, 0}}, .confirmed = true, .samples = {}};
  for (int k = static_cast<int>(10 * first + 0.5); k <= static_cast<int>(10 * last + 0.5); ++k) {
    GroundSample sample;
    sample.instant = k;
    const Vector<2> location = from + (0.1 * k - first) * velocity;
    sample.location = {static_cast<float>(location.x()), static_cast<float>(location.y())};
    sample.covariance = {0.01F, 0, 0.01F};
    sample.cameras = 1;
    if (clothing) {
      sample.colour = {static_cast<std::int8_t>(clothing->lightness), static_cast<std::int8_t>(clothing->a),
                       static_cast<std::int8_t>(clothing->b)};
      sample.colour_deviation = static_cast<std::uint8_t>(clothing->deviation);
    }
    tracklet.samples.push_back(sample);
  }
  return tracklet;
}

std::vector<Timestamp> clock_of(int instants) {
  std::vector<Timestamp> times;
  for (int k = 0; k < instants; ++k) times.push_back(timestamp_from_seconds(0.1 * k));
  return times;
}

using Chains = std::vector<std::vector<int>>;

Chains chains_of(const std::vector<GroundTracklet>& tracklets, const InSight& in_sight = {}) {
  Chains chains;
  for (const GroundChain& one : chain(tracklets, clock_of(1000), in_sight, {})) chains.push_back(one.members);
  return chains;
}

TEST(GroundJoin, LinksContinuingPerson) {
  EXPECT_EQ(chains_of({walk(1, 0, 3, {0, 0}, {2, 0}), walk(2, 5, 9, {10, 0.5}, {2, 0})}), (Chains{{0, 1}}));
}

TEST(GroundJoin, RejectsImpossibleSpeed) {
  EXPECT_EQ(chains_of({walk(1, 0, 3, {0, 0}, {2, 0}), walk(2, 5, 9, {45, 0}, {2, 0})}), (Chains{{0}, {1}}));
}

TEST(GroundJoin, PersonHasOnePositionAtATime) {
  EXPECT_EQ(chains_of({walk(1, 0, 3, {0, 0}, {2, 0}), walk(2, 2.5, 9, {5, 0.2}, {2, 0})}), (Chains{{0}, {1}}));
}

TEST(GroundJoin, TwoWhoMeetGoOnAsTheyWent) {
  const std::vector<GroundTracklet> tracklets = {walk(1, 0, 3, {0, 0}, {3, 0}), walk(2, 0, 3, {20, 0}, {-3, 0}),
                                                 walk(3, 4, 8, {12, 0}, {3, 0}), walk(4, 4, 8, {8, 0}, {-3, 0})};
  EXPECT_EQ(chains_of(tracklets), (Chains{{0, 2}, {1, 3}}));
}

TEST(GroundJoin, ClothesTellWhoIsWhoWhereWaysDoNot) {
  for (const bool swapped : {false, true}) {
    const Appearance& third = swapped ? blue : white;
    const Appearance& fourth = swapped ? white : blue;
    const std::vector<GroundTracklet> tracklets = {walk(1, 0, 3, {0, 0}, {1, 0}, white), walk(2, 0, 3, {0, 1}, {1, 0}, blue),
                                                   walk(3, 4, 8, {4, 0.2}, {1, 0}, third), walk(4, 4, 8, {4, 0.8}, {1, 0}, fourth)};
    EXPECT_EQ(chains_of(tracklets), swapped ? (Chains{{0, 3}, {1, 2}}) : (Chains{{0, 2}, {1, 3}}));
  }
}

/// A person who was followed through, cut where another's track ends nearby: they slow down, turn or come into shade there, so that
/// motion and clothes fit badly, and no other person is there who might be either piece.
int left_cut_although_alone(int cases, unsigned first_seed) {
  int cut = 0;
  for (int i = 0; i < cases; ++i) {
    std::mt19937 random(first_seed + static_cast<unsigned>(i));
    const auto uniform = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
    const double heading = uniform(0, 6.28), after = heading + uniform(0.8, 2.4);
    const Vector<2> before_it = uniform(4, 7) * Vector<2>(std::cos(heading), std::sin(heading));
    const Vector<2> after_it = uniform(4, 7) * Vector<2>(std::cos(after), std::sin(after));
    const Appearance light{.lightness = 80, .a = static_cast<float>(uniform(-3, 3)), .b = 0, .deviation = 3};
    Appearance shade = light;
    shade.lightness -= static_cast<float>(uniform(0, 20));
    std::vector<GroundTracklet> tracklets = {walk(1, 0, 5, {0, 0}, before_it, light),
                                             walk(1, 5.1, 10, 5.05 * before_it, after_it, shade)};
    tracklets.front().goes_on = true;
    for (int other = 0; other < 6; ++other)
      tracklets.push_back(walk(2 + other, 0, 99, {200.0 + 20 * other, 200}, {0, 0}, other % 2 == 0 ? white : blue));
    const Chains chains = chains_of(tracklets);
    if (std::find(chains.begin(), chains.end(), std::vector<int>{0, 1}) == chains.end()) ++cut;
  }
  return cut;
}

TEST(GroundJoin, KeepsTrackerLinkWithoutCompetitor) {
  EXPECT_EQ(left_cut_although_alone(100, 5100), 0) << "seeds 5100 to 5199";
  std::vector<GroundTracklet> swapped = {walk(1, 0, 5, {0, 0}, {3, 0}, white), walk(1, 5.1, 10, {15.3, 0}, {-2, 6}, blue)};
  swapped.front().goes_on = true;
  for (int other = 0; other < 6; ++other)
    swapped.push_back(walk(2 + other, 0, 99, {200.0 + 20 * other, 200}, {0, 0}, other % 2 == 0 ? white : blue));
  const Chains chains = chains_of(swapped);
  EXPECT_NE(std::find(chains.begin(), chains.end(), std::vector<int>{0}), chains.end()) << "white does not become blue";
}

TEST(GroundJoin, AtTheBorderOfSightPeopleLeaveAndOthersCome) {
  const std::vector<GroundTracklet> tracklets = {walk(1, 0, 3, {94, 30}, {2, 0}), walk(2, 12, 15, {100, 34}, {-2, 0})};
  EXPECT_EQ(chains_of(tracklets), (Chains{{0, 1}})) << "on an endless pitch no person leaves";
  EXPECT_EQ(chains_of(tracklets, [](const Vector<2>& location, Timestamp) { return location.x() < 101; }), (Chains{{0}, {1}}));
}

/// The best of all assignments of beginnings to ends.
double best_of_all(std::size_t tail, std::vector<char>& taken, const std::vector<GroundEnd>& tails,
                   const std::vector<GroundEnd>& heads, const GroundColours& colours) {
  if (tail == tails.size()) return 0;
  double best = best_of_all(tail + 1, taken, tails, heads, colours);
  for (std::size_t head = 0; head < heads.size(); ++head) {
    const std::optional<double> gain = gain_of_joining(tails[tail], heads[head], colours, {});
    if (taken[head] || !gain) continue;
    taken[head] = 1;
    best = std::max(best, *gain + best_of_all(tail + 1, taken, tails, heads, colours));
    taken[head] = 0;
  }
  return best;
}

TEST(GroundJoin, NoOtherChainsExplainMore) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    std::mt19937_64 engine(seed);
    const auto uniform = [&](double low, double high) {
      return low + (high - low) * static_cast<double>(engine() >> 11) * 0x1.0p-53;
    };
    std::vector<GroundEnd> tails, heads;
    std::vector<GroundColours::Detected> detected;
    for (int k = 0; k < 6; ++k) {
      GroundEnd head, tail;
      const double begun = uniform(0, 8);
      head.time = timestamp_from_seconds(begun);
      tail.time = timestamp_from_seconds(begun + uniform(0.2, 3));
      for (GroundEnd* end : {&head, &tail}) {
        end->state.x[0] = Vector<2>(uniform(0, 12), uniform(0, 12));
        end->state.x[1] = Vector<2>(uniform(-3, 3), uniform(-3, 3));
        end->state.P[0] = 0.1 * Matrix<2>::Identity();
        end->state.P[3] = end->state.P[5] = Matrix<2>::Identity();
        end->coming = std::exp(uniform(-10, -6));
        end->leaving = uniform(0.02, 0.7);
      }
      if (uniform(0, 1) < 0.8) {
        head.appearance = tail.appearance = uniform(0, 1) < 0.5 ? white : blue;
        detected.push_back({*head.appearance, 1});
      }
      tails.push_back(tail);
      heads.push_back(head);
    }
    const GroundColours colours(detected);
    const std::vector<int> next = best_links(tails, heads, colours, {});
    double sum = 0;
    for (std::size_t k = 0; k < next.size(); ++k) {
      if (next[k] != assign::kNoIndex) sum += *gain_of_joining(tails[k], heads[next[k]], colours, {});
    }
    std::vector<char> taken(heads.size(), 0);
    EXPECT_NEAR(sum, best_of_all(0, taken, tails, heads, colours), 1e-9) << "seed " << seed;
  }
}

}  // namespace
}  // namespace marey::track::ground::offline
