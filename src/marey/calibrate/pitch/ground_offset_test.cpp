#include "marey/calibrate/pitch/ground_offset.h"

#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "marey/calibrate/board/board_scene_test.h"

namespace marey::calibrate::pitch {
namespace {

constexpr double kBefore_s = 40;  // people move before the first camera starts, for the others

/// People who run to one place after another, each in a time of their own, and rest there.
class Crowd {
 public:
  Crowd(std::uint64_t seed, int people, double speed, double seconds) : random_(seed) {
    for (int i = 0; i < people; ++i) {
      Person person;
      double time = -kBefore_s;
      Vector<2> location(random_.uniform(0, 60), random_.uniform(0, 40)), velocity = Vector<2>::Zero(), aim = location;
      double left = 0;
      for (; time < seconds + kBefore_s; time += kTick) {
        if ((left -= kTick) < 0) {
          left = random_.uniform(1.5, 5);
          aim = Vector<2>(random_.uniform(0, 60), random_.uniform(0, 40));
        }
        const Vector<2> request =
            (aim - location).norm() > 0.5 ? Vector<2>((aim - location).normalized() * speed) : Vector<2>(0, 0);
        const Vector<2> change = request - velocity;
        velocity += change * std::min(1.0, 4 * kTick / std::max(1e-9, change.norm()));
        location += velocity * kTick;
        person.push_back(location);
      }
      people_.push_back(person);
    }
  }

  struct View {
    double offset_s = 0, rate_hz = 25, seconds = 12;
    double from_x = 0, to_x = 60;              // m: what it sees
    Vector<2> shift = Vector<2>::Zero();       // m, systematic, at the left
    Vector<2> shift_by_x = Vector<2>::Zero();  // and per m
    double noise = 0.15;                       // m
    double missed = 0.1;
    double swap = 0.02;  // a second: a path ends and another begins
  };

  std::vector<GroundPath> observed_by(const View& view) {
    std::vector<GroundPath> paths;
    for (const Person& person : people_) {
      GroundPath path;
      Vector<2> error = Vector<2>::Zero();
      for (int frame = 0; frame < view.seconds * view.rate_hz; ++frame) {
        const double own = frame / view.rate_hz, time = own + view.offset_s;
        const Vector<2> location = at(person, time);
        const bool ends = location.x() < view.from_x || location.x() > view.to_x || random_.uniform() < view.swap / view.rate_hz;
        if (ends && !path.samples.empty()) paths.push_back(std::exchange(path, {}));
        // Errors of a silhouette's foot hang together from frame to frame.
        const double keep = std::exp(-1 / (0.3 * view.rate_hz));
        error = keep * error + view.noise * std::sqrt(1 - keep * keep) * Vector<2>(random_.gaussian(1), random_.gaussian(1));
        if (location.x() < view.from_x || location.x() > view.to_x || random_.uniform() < view.missed) continue;
        path.samples.push_back(
            {own, location + view.shift + location.x() * view.shift_by_x + error, Matrix<2>::Identity() * view.noise * view.noise});
      }
      if (!path.samples.empty()) paths.push_back(path);
    }
    return paths;
  }

 private:
  static constexpr double kTick = 0.02;
  using Person = std::vector<Vector<2>>;

  static Vector<2> at(const Person& person, double time) {
    const double location = (time + kBefore_s) / kTick;
    const auto i = static_cast<std::size_t>(location);
    const double u = location - static_cast<double>(i);
    return (1 - u) * person.at(i) + u * person.at(i + 1);
  }

  board::Noise random_;
  std::vector<Person> people_;
};

std::vector<GroundOffset> found(const std::vector<std::vector<GroundPath>>& cameras) {
  return find_ground_offsets(cameras, std::vector<double>(cameras.size(), 0.0));
}

TEST(GroundOffset, IsFoundToAFractionOfAFrameWhateverTheCamerasDisagreeOn) {
  int within = 0, all = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    board::Noise random(seed + 100);
    const double offset = (seed % 2 == 0 ? 1 : -1) * random.uniform(0.1, 4);
    Crowd crowd(seed, 16, 4, 40);
    const auto a = crowd.observed_by({.to_x = 40, .shift = {0.3, -0.4}});
    const auto b = crowd.observed_by({.offset_s = offset, .from_x = 20, .shift = {-0.2, 0.1}, .shift_by_x = {0.01, 0}});
    const auto offsets = found({a, b});
    ASSERT_EQ(offsets[1].verdict, OffsetVerdict::found) << offset;
    EXPECT_NEAR(offsets[1].offset_s, offset, 0.05) << "deviation " << offsets[1].deviation_s;
    within += std::abs(offsets[1].offset_s - offset) < 2 * offsets[1].deviation_s;
    ++all;
    EXPECT_LT(offsets[1].deviation_s, 0.04);
    EXPECT_TRUE(contradicts(offsets[1], 0));
  }
  EXPECT_GE(within, all * 3 / 4) << "the deviation is honest";
}

TEST(GroundOffset, CamerasOfOneClockAreWithinTheirDeviationsOfIt) {
  Crowd crowd(5, 16, 4, 40);
  const auto offsets = found({crowd.observed_by({.to_x = 40}), crowd.observed_by({.from_x = 20, .shift = {0.5, 0.2}})});
  ASSERT_EQ(offsets[1].verdict, OffsetVerdict::found);
  EXPECT_LT(std::abs(offsets[1].offset_s), 4 * offsets[1].deviation_s);
  EXPECT_FALSE(contradicts(offsets[1], 0));
}

TEST(GroundOffset, GoesAlongAChainOfCamerasAtDifferentRates) {
  Crowd crowd(6, 20, 4, 40);
  const auto offsets = found({crowd.observed_by({.seconds = 20, .to_x = 25}),
                              crowd.observed_by({.offset_s = 1.234, .rate_hz = 50, .seconds = 20, .from_x = 35}),
                              crowd.observed_by({.offset_s = -0.777, .rate_hz = 10, .seconds = 20, .from_x = 10, .to_x = 50})});
  for (const auto& offset : offsets) ASSERT_EQ(offset.verdict, OffsetVerdict::found);
  EXPECT_EQ(offsets[0].offset_s, 0);
  EXPECT_NEAR(offsets[1].offset_s, 1.234, 0.05);
  EXPECT_NEAR(offsets[2].offset_s, -0.777, 0.05);
  EXPECT_GT(offsets[1].deviation_s, offsets[2].deviation_s);
}

TEST(GroundOffset, SaysWhyThereIsNone) {
  Crowd crowd(7, 16, 4, 40);
  EXPECT_EQ(found({crowd.observed_by({.to_x = 25}), crowd.observed_by({.offset_s = 1, .from_x = 35})})[1].verdict,
            OffsetVerdict::no_overlap);
  EXPECT_EQ(found({crowd.observed_by({}), {}})[1].verdict, OffsetVerdict::no_overlap);
  Crowd still(8, 16, 0, 40);
  EXPECT_EQ(found({still.observed_by({}), still.observed_by({.offset_s = 1})})[1].verdict, OffsetVerdict::no_motion);
  Crowd other(9, 16, 4, 40);
  EXPECT_EQ(found({crowd.observed_by({}), other.observed_by({})})[1].verdict, OffsetVerdict::ambiguous) << "different matches";
}

TEST(GroundOffset, PeopleWhoAllRunStraightTheSameWayDecideNothing) {
  std::vector<GroundPath> a, b;
  for (int i = 0; i < 8; ++i) {
    GroundPath here, there;
    for (int frame = 0; frame < 250; ++frame) {
      const double time = frame / 25.0;
      here.samples.push_back({time, {4 * time, 5.0 * i}, Matrix<2>::Identity() * 0.02});
      there.samples.push_back({time, {4 * (time + 0.4) + 0.3, 5.0 * i}, Matrix<2>::Identity() * 0.02});
    }
    a.push_back(here), b.push_back(there);
  }
  EXPECT_EQ(found({a, b})[1].verdict, OffsetVerdict::ambiguous);
}

}  // namespace
}  // namespace marey::calibrate::pitch
