#include "marey/track/offline/returns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "marey/assign/sparse_assignment.h"
#include "marey/track/offline/join.h"

namespace marey::track::offline {
namespace {

constexpr double kReturnsRate = 10;  // Hz
constexpr double kImageWidth = 800, kImageHeight = 600, kTallness = 80;
const Box kImage{0, 0, kImageWidth, kImageHeight};

/// People who walk through the image at a height of their own, leave it at a side, and come back there after 2 to 10 s; some do
/// not, and another person comes in their stead.
class ComingAndGoing {
 public:
  ComingAndGoing(unsigned seed, bool own_clothes, bool return_at_all = true, int frames = 600, int people = 12)
      : random_(seed), own_clothes_(own_clothes), return_at_all_(return_at_all) {
    for (int k = 0; k < people; ++k) people_.push_back(any_person(uniform(50, kImageWidth - 50)));
    for (int frame = 0; frame < frames; ++frame) step(frame);
  }

  struct Visit {
    int person = 0, track = 0;
  };
  TrackletLog log;
  std::map<int, std::vector<Visit>> visits;  // by person
  std::map<int, int> person_of_track;

 private:
  struct Person {
    int id = 0, track = 0;
    double x = 0, y = 0, vx = 0;
    int comes_back = 0;  // frame; while it is away
    bool away = false;
    std::array<Appearance, 3> clothing;
  };

  double uniform(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
  float noise() { return static_cast<float>(std::normal_distribution<double>(0, 2)(random_)); }

  Person any_person(double x) {
    Person one;
    one.id = ++last_person_;
    one.track = ++last_track_;
    one.x = x;
    one.y = uniform(100, kImageHeight - 60);
    one.vx = (uniform(0, 1) < 0.5 ? 1 : -1) * uniform(40, 160);
    const bool red = one.id % 2 == 0;
    for (std::size_t part = 0; part < 3; ++part) {
      const double lightness = own_clothes_ ? uniform(15, 90) : red ? 40 : 70;
      const double a = own_clothes_ ? uniform(-40, 40) : red ? 35 : 0, b = own_clothes_ ? uniform(-40, 40) : red ? 10 : 5;
      one.clothing[part] = {static_cast<float>(lightness), static_cast<float>(a), static_cast<float>(b), 3};
    }
    begin(one);
    return one;
  }

  void begin(const Person& one) {
    visits[one.id].push_back({one.id, one.track});
    person_of_track[one.track] = one.id;
  }

  void step(int frame) {
    std::vector<Track<2>> tracks;
    std::vector<image::Clothes> clothes;
    for (Person& one : people_) {
      if (one.away && frame >= one.comes_back) come_back(one);
      if (one.away) continue;
      one.x += one.vx / kReturnsRate;
      one.y = std::clamp(one.y + uniform(-3, 3), 90.0, kImageHeight - 50);
      if (one.x < 0 || one.x > kImageWidth) {
        one.away = true;
        one.comes_back = frame + static_cast<int>(kReturnsRate * uniform(2, 10));
        continue;
      }
      Track<2> track;
      track.id = TrackId{one.track};
      track.position = {one.x, one.y};
      const double left = std::max(0.0, one.x - 16), right = std::min(kImageWidth, one.x + 16);
      track.box = Box{left, one.y - kTallness / 2, std::max(4.0, right - left), kTallness};
      track.score = 0.9;
      track.observation = static_cast<int>(clothes.size());
      std::array<Appearance, 3> detected = one.clothing;
      for (Appearance& part : detected) part.lightness += noise(), part.a += noise(), part.b += noise();
      clothes.push_back({detected[0], detected[1], detected[2]});
      tracks.push_back(track);
    }
    std::sort(tracks.begin(), tracks.end(), [](const Track<2>& a, const Track<2>& b) { return a.id < b.id; });
    log.add(frame, timestamp_from_seconds(frame / kReturnsRate), tracks, clothes);
  }

  void come_back(Person& one) {
    const double side = one.x < kImageWidth / 2 ? 1 : kImageWidth - 1;
    if (!return_at_all_ || uniform(0, 1) < 1.0 / 6) {
      one = any_person(uniform(0, 1) < 0.5 ? 1 : kImageWidth - 1);
      one.vx = one.x < kImageWidth / 2 ? std::abs(one.vx) : -std::abs(one.vx);
      return;
    }
    one.away = false;
    one.track = ++last_track_;
    one.x = side;
    one.y = std::clamp(one.y + std::normal_distribution<double>(0, 40)(random_), 100.0, kImageHeight - 60);
    one.vx = (side < kImageWidth / 2 ? 1 : -1) * uniform(40, 160);
    begin(one);
  }

  std::mt19937 random_;
  bool own_clothes_, return_at_all_;
  int last_person_ = 0, last_track_ = 0;
  std::vector<Person> people_;
};

struct Outcome {
  int returns = 0, right = 0, joined_wrongly = 0;
};

struct Scenes {
  bool own_clothes = true;
  unsigned first_seed = 0;
  int scenes = 10, frames = 600, people = 12;
};

Outcome outcome_of(const Scenes& scenes) {
  Outcome outcome;
  for (int k = 0; k < scenes.scenes; ++k) {
    ComingAndGoing scene(scenes.first_seed + static_cast<unsigned>(k), scenes.own_clothes, true, scenes.frames, scenes.people);
    std::vector<TrackletLog::Tracklet> tracklets = scene.log.take_tracklets();
    for (const auto& [person, of] : scene.visits) outcome.returns += static_cast<int>(of.size()) - 1;
    for (const Returned& pair : find_returned(tracklets, scene.log, kImage)) {
      const int before = scene.person_of_track[tracklets[static_cast<std::size_t>(pair.before)].front().id];
      const int after = scene.person_of_track[tracklets[static_cast<std::size_t>(pair.after)].front().id];
      ++(before == after ? outcome.right : outcome.joined_wrongly);
      EXPECT_GT(pair.away, 0);
      EXPECT_LE(pair.probability, 1 + 1e-9);
    }
  }
  return outcome;
}

TEST(Returns, ReidentifiesDistinctClothing) {
  const Outcome outcome = outcome_of({.own_clothes = true, .first_seed = 500});
  ASSERT_GT(outcome.returns, 100);
  EXPECT_GT(outcome.right, 0.7 * outcome.returns) << "seeds 500 to 509";
  EXPECT_LE(outcome.joined_wrongly, 0.01 * outcome.returns);
}

/// Team-mates wear the same: neither place and time of an entry, nor rates learned from such pairs, may join them.
TEST(Returns, TwoTeamsGetNoNumberOfAnother) {
  for (const int frames : {120, 200, 600}) {
    for (const int people : {12, 6, 3}) {
      const Outcome outcome =
          outcome_of({.own_clothes = false, .first_seed = 600, .scenes = 20, .frames = frames, .people = people});
      EXPECT_LE(outcome.joined_wrongly, 0.01 * outcome.returns) << frames << " frames, " << people << " people, seeds 600 to 619";
    }
  }
}

TEST(Returns, RarelyLinksWithoutReturns) {
  for (const bool own_clothes : {true, false}) {
    int came = 0, joined = 0;
    for (unsigned seed = 700; seed < 710; ++seed) {
      ComingAndGoing scene(seed, own_clothes, false);
      const std::vector<TrackletLog::Tracklet> tracklets = scene.log.take_tracklets();
      came += static_cast<int>(scene.visits.size()) - 12;
      joined += static_cast<int>(find_returned(tracklets, scene.log, kImage).size());
    }
    ASSERT_GT(came, 100);
    EXPECT_LE(joined, 0.03 * came) << (own_clothes ? "own clothes" : "two teams") << ", seeds 700 to 709";
  }
}

TEST(Returns, ContinuingPersonIsNoReturn) {
  ComingAndGoing scene(1, true);
  const std::vector<TrackletLog::Tracklet> tracklets = scene.log.take_tracklets();
  EXPECT_TRUE(find_returned(tracklets, scene.log, Box{-1000, -1000, 3000, 3000}).empty()) << "no person is near the border";
  EXPECT_TRUE(find_returned({}, scene.log, kImage).empty());
}

TEST(Returns, TheSecondPassGivesOneNumberAndFillsNothingBetween) {
  ComingAndGoing scene(2, true);
  TrackletLog log = scene.log;
  JoinOptions options;
  options.view = kImage;
  JoinReport report;
  const std::vector<TrackRow> rows = join(log, options, &report);
  ASSERT_FALSE(report.returned.empty());
  std::map<int, std::map<int, int>> numbers;  // by person: rows of each number
  std::map<int, std::vector<int>> frames;
  for (const TrackRow& row : rows) {
    ++numbers[scene.person_of_track[row.first_id]][row.id];
    frames[row.id].push_back(row.frame);
  }
  int people_of_one_number = 0;
  for (const auto& [person, of] : numbers) people_of_one_number += scene.visits[person].size() > 1 && of.size() == 1;
  EXPECT_GT(people_of_one_number, 4);
  bool gap = false;
  for (auto& [id, at] : frames) {
    for (std::size_t i = 1; i < at.size(); ++i) {
      EXPECT_GT(at[i], at[i - 1]) << "no person is in two places at once";
      gap = gap || at[i] - at[i - 1] > 2 * kReturnsRate;
    }
  }
  EXPECT_TRUE(gap);
}

/// All options to give each of a few ends at most one beginning: the assignment that decides is the best of them.
TEST(Returns, TheAssignmentIsTheBestOfAll) {
  std::mt19937 random(3);
  for (int round = 0; round < 200; ++round) {
    constexpr int kCount = 5;
    std::vector<assign::GatedPair> pairs;
    std::map<std::pair<int, int>, double> gains;
    for (int row = 0; row < kCount; ++row) {
      for (int column = row + 1; column < kCount; ++column) {
        const double gain = std::uniform_real_distribution(-4.0, 6.0)(random);
        pairs.push_back({row, column, gain});
        gains[{row, column}] = gain;
      }
    }
    double best = 0;
    const auto search = [&](auto&& self, int row, int taken, double sum) -> void {
      best = std::max(best, sum);
      if (row == kCount) return;
      self(self, row + 1, taken, sum);
      for (int column = row + 1; column < kCount; ++column) {
        if ((taken & (1 << column)) == 0) self(self, row + 1, taken | (1 << column), sum + gains[{row, column}]);
      }
    };
    search(search, 0, 0, 0);
    double sum = 0;
    const std::vector<int> next = assign::sparse_assignment(kCount, kCount, pairs);
    for (int row = 0; row < kCount; ++row) {
      if (next[static_cast<std::size_t>(row)] != assign::kNoIndex) sum += gains[{row, next[static_cast<std::size_t>(row)]}];
    }
    EXPECT_NEAR(sum, best, 1e-9) << "seed 3, round " << round;
  }
}

}  // namespace
}  // namespace marey::track::offline
