#include "marey/track/ground/ground_tracker.h"

#include <set>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/track/ground/ground_scene_test.h"

namespace marey {
namespace {

using namespace ground_scene;

class EveryAssociation : public testing::TestWithParam<GroundAssociation> {
 protected:
  std::unique_ptr<GroundTracker> make(std::vector<GroundView> views) {
    return make_ground_tracker({.associate = GetParam()}, std::move(views));
  }
};

TEST_P(EveryAssociation, GivesOneIdentityAcrossCameras) {
  const std::vector<GroundView> views = {view_of(0, 60, 0, 60), view_of(40, 100, 0, 60)};
  const auto tracker = make(views);
  Random random(1);
  std::set<int> ids;
  run(
      *tracker, 2, 500,
      [&](int frame, Looks& seen) {
        const Vector<2> place(5 + 0.18 * frame, 30);
        for (int c = 0; c < 2; ++c) {
          const bool sees = c == 0 ? place.x() < 60 : place.x() > 40;
          if (sees && !random.chance(0.1)) seen[c].push_back(seen_at(views[c], c, place + random.gaussian(0.15)));
        }
      },
      [&](int frame, std::span<const Track<2>> tracks) {
        if (frame < 10) return;
        ids.insert(id_at(tracks, {5 + 0.18 * frame, 30}));
        EXPECT_EQ(confirmed(tracks), 1) << "frame " << frame;
      });
  EXPECT_EQ(ids.size(), 1U);
  EXPECT_FALSE(ids.contains(0));
}

INSTANTIATE_TEST_SUITE_P(All, EveryAssociation, testing::Values(GroundAssociation::gnn, GroundAssociation::mht));

TEST(GroundTracker, NamesItsAssociations) {
  EXPECT_EQ(ground_association_named("mht"), GroundAssociation::mht);
  EXPECT_THROW(ground_association_named("nearest"), Error);
}

}  // namespace
}  // namespace marey
