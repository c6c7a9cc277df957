#include "marey/simulate/square/square_motion.h"

#include <algorithm>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "marey/simulate/square/square_boxes.h"
#include "marey/simulate/square/square_cameras.h"

namespace marey::simulate::square {
namespace {

TEST(SquareMotion, HundredsComeAndLeaveAtEverySide) {
  SquareMotion square(1);
  std::set<int> all;
  std::map<int, Vector<2>> last;
  std::vector<double> nearest;
  int left_at[4] = {};
  for (int k = 0; k < 360; ++k) {
    square.advance(k / 2.0);
    std::map<int, Vector<2>> inside;
    for (const SquarePerson& person : square.people()) {
      if (square.holds(person.location)) inside[person.id] = person.location;
    }
    for (const auto& [id, location] : inside) {
      all.insert(id);
      double next = 100;
      for (const auto& [other, there] : inside) {
        if (other != id) next = std::min(next, (there - location).norm());
      }
      nearest.push_back(next);
    }
    for (const auto& [id, location] : last) {
      if (inside.count(id) > 0) continue;
      const double to[4] = {location.y(), 12 - location.y(), location.x(), 36 - location.x()};
      ++left_at[std::min_element(to, to + 4) - to];
    }
    last = inside;
  }
  EXPECT_GT(all.size(), 250U);
  EXPECT_LT(all.size(), 380U);
  std::nth_element(nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(nearest.size() / 2), nearest.end());
  EXPECT_LT(nearest[nearest.size() / 2], 1.0);
  for (const int count : left_at) EXPECT_GT(count, 10);
}

TEST(SquareMotion, IsTheSameAtEveryRate) {
  SquareMotion slow(3), fast(3);
  slow.advance(20);
  for (int k = 1; k <= 500; ++k) fast.advance(k * 0.04);
  ASSERT_EQ(slow.people().size(), fast.people().size());
  for (std::size_t i = 0; i < slow.people().size(); ++i)
    EXPECT_LT((slow.people()[i].location - fast.people()[i].location).norm(), 1e-9) << i;
}

TEST(SquareMotion, ExactBoxesStandWherePeopleDo) {
  SquareMotion square(2);
  const Rig rig = square_cameras(7, 2, {}, 2);
  Random random(1);
  std::size_t detected = 0;
  for (const RigCamera& each : rig.cameras) {
    const Camera camera = each.camera().value();
    const auto boxes = square_boxes(square.people(), square, camera, 0, {.missed = 0, .size_noise = 0, .hidden_missed = 0}, random);
    detected += boxes.size();
    for (const LabelledBox& box : boxes) {
      const auto foot = camera.ray(box.box.foot());
      ASSERT_TRUE(foot);
      const Vector<2> at = (foot->origin - foot->origin.z() / foot->direction.z() * foot->direction).head<2>();
      double nearest = 100;
      for (const SquarePerson& person : square.people()) nearest = std::min(nearest, (person.location - at).norm());
      if (box.box.bottom() < each.size->height - 1) {
        EXPECT_LT(nearest, 0.3);
      }
    }
  }
  EXPECT_GT(detected, 40U);
}

}  // namespace
}  // namespace marey::simulate::square
