#include "marey/pipeline/calibrate/live_people.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "marey/calibrate/people/people_coverage.h"
#include "marey/simulate/room/room_keypoints.h"

namespace marey::pipeline::calibrate {
namespace {

using marey::calibrate::people::PeopleCoverage;
using marey::simulate::room::RoomOptions;
using marey::simulate::room::RoomScene;

const std::vector<std::string> kNames{"cam1", "cam2", "cam3", "cam4"};

RoomScene room(double seconds) {
  RoomOptions options;
  options.cameras = 4;
  options.actors = 1;
  options.rate_hz = 25;
  options.frames = static_cast<std::int64_t>(25 * seconds);
  options.distorted = false;
  return RoomScene(options);
}

/// A walk, watched `hz` times a second by the cameras and with the body's posture that the two functions name.
template <typename Looks, typename At>
PeopleCoverage watched(const RoomScene& scene, double seconds, double hz, Looks looks, At at) {
  PeopleCoverage coverage(kNames.size());
  for (int k = 0; k < seconds * hz; ++k) {
    std::vector<std::vector<Keypoints<2>>> people(kNames.size());
    std::vector<PeopleCoverage::View> seen;
    for (std::size_t c = 0; c < kNames.size(); ++c) {
      const double time_s = k / hz;
      if (looks(c, time_s))
        people[c] = keypoints_observed(scene, static_cast<int>(c), at(time_s), static_cast<std::uint64_t>(k),
                                       {.noise_px = 2, .outliers = 0});
      seen.push_back({people[c], *scene.rig().cameras[c].size});
    }
    coverage.add(seen);
  }
  return coverage;
}

const auto kAll = [](std::size_t, double) { return true; };
const auto kWalking = [](double time_s) { return time_s; };

TEST(PeopleCoverage, HalfAMinuteOfAWalkIsEnough) {
  const RoomScene scene = room(30);
  const PeopleCoverage early = watched(scene, 2, 10, kAll, kWalking), late = watched(scene, 30, 10, kAll, kWalking);
  EXPECT_FALSE(early.images().is_enough());
  EXPECT_FALSE(early.missing(kNames).empty());
  EXPECT_TRUE(late.images().is_enough());
  EXPECT_EQ(late.missing(kNames), std::vector<std::string>{});
}

TEST(PeopleCoverage, CountsTheSameHoweverFastTheNetworkIs) {
  const RoomScene scene = room(20);
  const PeopleCoverage slow = watched(scene, 20, 8, kAll, kWalking), fast = watched(scene, 20, 25, kAll, kWalking);
  for (std::size_t c = 0; c < kNames.size(); ++c) {
    EXPECT_GT(slow.images().views(c), 0);
    EXPECT_LT(fast.images().views(c), 2 * slow.images().views(c)) << c;
  }
}

TEST(PeopleCoverage, StandingStillShowsNothingNew) {
  const RoomScene scene = room(20);
  const PeopleCoverage coverage = watched(scene, 20, 25, kAll, [](double) { return 5.0; });
  for (std::size_t c = 0; c < kNames.size(); ++c) EXPECT_LE(coverage.images().views(c), 5) << c;
  EXPECT_FALSE(coverage.images().is_enough());
}

TEST(PeopleCoverage, SaysWhoHasSeenNobody) {
  const RoomScene scene = room(30);
  const PeopleCoverage coverage = watched(scene, 30, 10, [](std::size_t c, double) { return c != 2; }, kWalking);
  EXPECT_FALSE(coverage.images().is_enough());
  EXPECT_EQ(coverage.missing(kNames), std::vector<std::string>{"camera \"cam3\" has seen no person: walk before it"});
}

/// Two pairs that see the walker in turn: each camera is covered, and nothing says how the pairs stand to each other.
TEST(PeopleCoverage, SaysWhoHasSeenNobodyTogether) {
  const RoomScene scene = room(60);
  const PeopleCoverage coverage = watched(
      scene, 60, 10, [](std::size_t c, double time_s) { return (c < 2) == (static_cast<int>(time_s / 5) % 2 == 0); }, kWalking);
  EXPECT_FALSE(coverage.images().is_enough());
  const std::vector<std::string> missing = coverage.missing(kNames);
  ASSERT_GE(missing.size(), 2);
  EXPECT_EQ(missing[0], "camera \"cam3\" has seen no person together with \"cam1\": walk where both see you");
}

TEST(LivePeople, LostFramesAreFramesWithoutPeople) {
  KeypointSequence sequence;
  sequence.frames.resize(4);
  for (std::size_t k = 0; k < 4; ++k) sequence.frames[k].resize(k + 1);
  const std::vector<double> times_s{10, 10.041, 10.16, 10.2};
  const KeypointSequence placed = by_times(sequence, times_s, 25);
  ASSERT_EQ(placed.frames.size(), 6);
  const std::vector<std::size_t> people{1, 2, 0, 0, 3, 4};
  for (std::size_t k = 0; k < people.size(); ++k) EXPECT_EQ(placed.frames[k].size(), people[k]) << k;
}

}  // namespace
}  // namespace marey::pipeline::calibrate
