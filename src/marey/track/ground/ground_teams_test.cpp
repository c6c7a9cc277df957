#include "marey/track/ground/ground_teams.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "marey/track/ground/ground_run.h"
#include "marey/track/ground/ground_scene_test.h"

namespace marey::track::ground {
namespace {

class Shirts {
 public:
  explicit Shirts(unsigned seed) : random_(seed) {}

  Appearance in(double lightness, double a, double b, double spread) {
    std::normal_distribution<double> noise(0, spread);
    return {.lightness = static_cast<float>(lightness + noise(random_)),
            .a = static_cast<float>(a + noise(random_)),
            .b = static_cast<float>(b + noise(random_)),
            .deviation = 3};
  }

 private:
  std::mt19937 random_;
};

/// White and blue as a camera with a cast of blue shows them, and two referees.
std::vector<Appearance> match(Shirts& shirts) {
  std::vector<Appearance> detected;
  for (int i = 0; i < 1000; ++i) {
    detected.push_back(shirts.in(63, 13, -28, 4));
    detected.push_back(shirts.in(39, 21, -47, 4));
    if (i % 6 == 0) detected.push_back(shirts.in(25, 2, -4, 4));
  }
  return detected;
}

TEST(GroundTeams, ShirtsOfOneHueAreToldApart) {
  double mean = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    Shirts shirts(seed);
    const auto teams = GroundTeams::learn(match(shirts));
    ASSERT_TRUE(teams) << "seed " << seed;
    EXPECT_GT(teams->apart(), 5);
    const Appearance white = shirts.in(63, 13, -28, 3), blue = shirts.in(39, 21, -47, 3), other = shirts.in(63, 13, -28, 3);
    EXPECT_GT(teams->same(white, other), 0.4) << "seed " << seed;
    EXPECT_LE(teams->same(white, other), std::log(2) + 1e-9);
    EXPECT_LT(teams->same(white, blue), 0) << "seed " << seed;
    mean += teams->same(white, blue) / 100;
    EXPECT_DOUBLE_EQ(teams->same(white, blue), teams->same(blue, white));
    const Appearance referee = shirts.in(25, 2, -4, 2);
    EXPECT_GT(teams->same(white, referee), -1) << "neither's colour says nothing, seed " << seed;
  }
  EXPECT_LT(mean, -1.5);
}

TEST(GroundTeams, PeopleInClothesOfTheirOwnAreNotTakenForOthers) {
  int pairs = 0, flagged = 0;  // twenty people may happen to be of two kinds: that says nothing false of any person
  for (unsigned seed = 0; seed < 100; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> lightness(15, 90), colour(-40, 40);
    Shirts shirts(seed);
    std::vector<Appearance> detected;
    for (int person = 0; person < 20; ++person) {
      const double l = lightness(random), a = colour(random), b = colour(random);
      for (int i = 0; i < 100; ++i) detected.push_back(shirts.in(l, a, b, 4));
    }
    const auto teams = GroundTeams::learn(detected);
    for (std::size_t i = 1; teams && i < detected.size(); i += 2) {
      ++pairs;
      flagged += teams->same(detected[i - 1], detected[i]) < -1 ? 1 : 0;
    }
  }
  EXPECT_GT(pairs, 1000);
  EXPECT_LT(flagged, 0.01 * pairs) << "seeds 0 to 99";
}

/// Two of different teams run side by side and nearer to each other, meet, one of them hidden for a while, and part again to the
/// sides that they came from. Others of both teams stand about. In how many cases a person is exchanged in the end.
int swaps_between_teams(int cases, unsigned first_seed, const GroundLearnOptions& learn) {
  using namespace ground_scene;
  int swapped = 0;
  for (int i = 0; i < cases; ++i) {
    Random random(first_seed + static_cast<unsigned>(i));
    Shirts shirts(first_seed + static_cast<unsigned>(i));
    const auto views = ground_views({view_of(0, 100, 0, 60)});
    constexpr int kFrames = 150, kMeet = 75;
    const auto method = [](double angle) { return Vector<2>(std::cos(angle), std::sin(angle)); };
    const double heading = random.uniform(0, 6.28), nearing = random.uniform(1, 2), noise = random.uniform(0.15, 0.3);
    const Vector<2> together = random.uniform(1, 4) * method(heading);
    const int hidden_from = kMeet - static_cast<int>(random.uniform(0, 12)),
              hidden_until = kMeet + static_cast<int>(random.uniform(0, 6));
    const auto at = [&](int person, int frame) -> Vector<2> {
      const double aside = 0.2 + nearing * std::abs(frame - kMeet) / rate;
      return Vector<2>(50, 30) + (frame - kMeet) / rate * together + (person == 0 ? 1 : -1) * aside * method(heading + 1.57);
    };
    std::vector<std::array<TrackId, 2>> owner(kFrames, {TrackId{0}, TrackId{0}});
    std::size_t decided = 0;
    GroundRun people({}, {}, learn, views, [&](const GroundInstant&, std::span<const ObservationMatch> matches) {
      for (const ObservationMatch& match : matches) {
        if (match.observation < 2) owner[decided][static_cast<std::size_t>(match.observation)] = match.track;
      }
      ++decided;
    });
    for (int frame = 0; frame < kFrames; ++frame) {
      std::vector<Observation<2>> detected;
      const auto show = [&](const Vector<2>& location, bool white) {
        detected.push_back(observed_at(views->view_at(CameraId{0}, {}), 0, location + random.gaussian(noise), noise));
        detected.back().box.reset();
        detected.back().appearance = white ? shirts.in(63, 13, -28, 4) : shirts.in(39, 21, -47, 4);
      };
      show(at(0, frame), true);
      show(at(1, frame), false);
      for (int k = 0; k < 8; ++k) show({8.0 + 10 * k, 4}, k % 2 == 0);
      if (frame >= hidden_from && frame < hidden_until)
        detected[0].value = {3, 55}, detected[0].score = 0.01;  // nothing to be followed
      const Timestamp now = timestamp_from_seconds(frame / rate);
      const CameraObservations camera{CameraId{0}, now, detected};
      people.step(frame, now, {&camera, 1});
    }
    const offline::GroundRecorder::Joined joined = std::move(people).finish({});
    const auto person = [&](int which, int frame) {
      return joined.person_of(owner[static_cast<std::size_t>(frame)][static_cast<std::size_t>(which)], frame);
    };
    for (const int which : {0, 1}) {
      const auto before = person(which, kMeet - 40), after = person(1 - which, kMeet + 40);
      if (!before || before != after) continue;
      ++swapped;
      break;
    }
  }
  return swapped;
}

TEST(GroundTeams, TwoOfDifferentTeamsAreNotExchanged) {
  const int without = swaps_between_teams(100, 700, {.teams = false}), with = swaps_between_teams(100, 700, {});
  EXPECT_LE(with, 1) << "seeds 700 to 799";
  EXPECT_GT(without, 2) << "the scene must tempt";
}

TEST(GroundTeams, SingleShirtGivesNoTeams) {
  Shirts shirts(1);
  std::vector<Appearance> detected;
  EXPECT_FALSE(GroundTeams::learn(detected));
  for (int i = 0; i < 2000; ++i) detected.push_back(shirts.in(60, 10, -20, 4));
  EXPECT_FALSE(GroundTeams::learn(detected)) << "all alike";
  const std::vector<Appearance> same(1000, Appearance{.lightness = 50, .a = 0, .b = 0, .deviation = 2});
  EXPECT_FALSE(GroundTeams::learn(same)) << "not even noise";
  Shirts other(2);
  const std::vector<Appearance> all = match(other);
  EXPECT_FALSE(GroundTeams::learn(std::span(all).first(100)));
}

}  // namespace
}  // namespace marey::track::ground
