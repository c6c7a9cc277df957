#include "marey/track/roster/rigid_neighbours.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "marey/core/geometry.h"
#include "marey/filter/random_stream.h"
#include "marey/geometry/rigid.h"

namespace marey::track::roster {
namespace {

/// Two bones of five markers that swing against each other, and one marker that moves independently.
std::vector<Vector<3>> body_at(double t) {
  std::vector<Vector<3>> locations;
  for (int bone = 0; bone < 2; ++bone) {
    const Rigid3 world_from_bone{
        geometry::rotation_from({std::sin(t * (1.3 + bone)), 0.6 * std::cos(2.1 * t), 0.5 * t * (1 - 0.4 * bone)}),
        {std::cos(t), std::sin(0.7 * t) + 0.4 * bone * std::sin(3 * t), 1 + 0.2 * bone}};
    for (int k = 0; k < 5; ++k)
      locations.push_back(world_from_bone * Vector<3>(0.08 * k, 0.05 * ((k * 7) % 3), 0.06 * ((k * 5) % 4)));
  }
  locations.push_back({std::sin(5 * t), std::cos(4 * t), std::sin(3 * t)});
  return locations;
}

void show(RigidNeighbours& companions, const std::vector<Vector<3>>& locations, const std::vector<int>& hidden,
          filter::RandomStream& random) {
  companions.begin_frame();
  for (int i = 0; i < std::ssize(locations); ++i) {
    if (std::find(hidden.begin(), hidden.end(), i) != hidden.end()) continue;
    const auto [x, y] = random.normal_pair();
    companions.observe_frame(i, locations[i] + 0.0003 * Vector<3>(x, y, random.normal_pair().first));
  }
  companions.end_frame(1.0 / 120);
}

TEST(RigidNeighbours, AHiddenMarkerGoesWithItsBone) {
  constexpr double dt = 1.0 / 120;
  filter::RandomStream random(3);
  RigidNeighbours companions;
  for (std::size_t i = 0; i < body_at(0).size(); ++i) EXPECT_EQ(companions.enrol(), static_cast<int>(i));
  int frame = 0;
  for (; frame < 600; ++frame) show(companions, body_at(frame * dt), {}, random);
  const int last = frame + 60;
  for (; frame < last; ++frame) {
    const auto truth = body_at(frame * dt);
    show(companions, truth, {2, 7, 10}, random);
    for (const int marker : {2, 7}) {
      const auto location = companions.position_of(marker);
      ASSERT_TRUE(location);
      EXPECT_LT((location->position - truth[marker]).norm(), 0.004);
      EXPECT_LT(std::sqrt(location->variance), 0.01);
    }
    EXPECT_FALSE(companions.position_of(10)) << "this one has no neighbours";
  }
}

TEST(RigidNeighbours, SaysNothingBeforeItKnows) {
  filter::RandomStream random(4);
  RigidNeighbours companions;
  for (std::size_t i = 0; i < body_at(0).size(); ++i) companions.enrol();
  show(companions, body_at(0), {}, random);
  EXPECT_FALSE(companions.position_of(2));
  show(companions, body_at(0.01), {2}, random);
  EXPECT_FALSE(companions.position_of(2));
}

}  // namespace
}  // namespace marey::track::roster
