#include "marey/track/ground/offline/entry_exit_map.h"

#include <gtest/gtest.h>

#include "marey/track/ground/ground_scene_test.h"

namespace marey::track::ground::offline {
namespace {

using EntryExit = EntryExitMap::EntryExit;

TEST(EntryExitMap, NothingSeenIsThePrior) {
  const EntryExitMap openness;
  EXPECT_LT(openness.coming({{0, 0}, false, 1}), openness.coming({{0, 0}, true, 1}));
  EXPECT_LT(openness.leaving({{0, 0}, false, 1}), 0.1);
  EXPECT_GT(openness.leaving({{0, 0}, true, 1}), 0.5);
}

TEST(EntryExitMap, EstimatesEntryExitDensity) {
  ground_scene::Random random(1);
  std::vector<EntryExit> came, left;
  for (int i = 0; i < 200; ++i) {
    came.push_back({{random.uniform(0, 36), random.uniform(0, 1)}, false, 1});    // along one side
    left.push_back({{random.uniform(0, 36), random.uniform(11, 12)}, false, 1});  // and the other
    left.push_back({{random.uniform(0, 36), random.uniform(5, 7)}, false, 0});    // in the middle they are lost
  }
  const EntryExitMap openness(came, left, 180);
  const double at_side = openness.coming({{18, 0.5}, false, 0}), in_the_middle = openness.coming({{18, 6}, false, 0});
  EXPECT_NEAR(at_side, 200 / 180.0 / 36 / 3, 0.005) << "spread over some three metres";
  EXPECT_GT(at_side, 20 * in_the_middle);
  EXPECT_GT(openness.leaving({{18, 11.5}, false, 0}), 0.9);
  EXPECT_LT(openness.leaving({{18, 6}, false, 0}), 0.1);
}

TEST(EntryExitMap, TrackIsNotItsOwnEvidence) {
  const std::vector<EntryExit> one = {{{5, 5}, false, 1}};
  const EntryExitMap alone(one, one, 60), prior;
  EXPECT_LE(alone.coming(one.front()), prior.coming(one.front()));
  EXPECT_NEAR(alone.leaving(one.front()), prior.leaving(one.front()), 1e-9);
}

}  // namespace
}  // namespace marey::track::ground::offline
