#include "marey/analyse/gait/force_curves.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace marey::analyse::gait {
namespace {

constexpr double kPlateRate = 1000, kMarkerRate = 100;

/// One contact of the left foot from 0.5 to 1.1 s, of a person who walks straight.
struct Walk {
  FootForces forces;
  MarkerPath sacrum;
  std::vector<GaitCycles::Cycle> cycles = {{Side::left, 0.5, 1.5, 1.1}, {Side::left, 1.5, 2.5, 2.1}, {Side::right, 0.5, 1.5, 1.1}};

  explicit Walk(const Vector<2>& way) {
    forces.rate_hz = kPlateRate;
    for (auto& foot : forces.feet) foot.resize(3000);
    const Vector<2> left(-way.y(), way.x());
    for (std::size_t s = 600; s < 1200; ++s) {
      FootLoad load;
      load.force.head<2>() = 30 * way - 7 * left;  // to the right, which is medial of a left foot
      load.force.z() = 500;
      forces.feet[0][s] = load;
    }
    PlateContact contact;
    contact.first = 600;
    contact.last = 1199;
    contact.strike_s = 0.5;
    contact.off_s = 1.1;
    contact.side = Side::left;
    forces.contacts.push_back(contact);
    for (int r = 0; r < 300; ++r) sacrum.emplace_back(Vector<3>(way.x() * r * 0.012, way.y() * r * 0.012, 0.9));
  }
};

TEST(ForceCurves, AreInTheWalkersDirections) {
  for (const double degrees : {0.0, 90.0, 215.0}) {
    const double angle = degrees * std::numbers::pi / 180;
    const Walk walk({std::cos(angle), std::sin(angle)});
    const auto curves = ground_reaction_curves(walk.forces, -0.1, walk.cycles, walk.sacrum, kMarkerRate);
    ASSERT_EQ(curves.size(), 3U) << "of the left side alone";
    const std::array<double, 3> expected = {30, 7, 500};
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(curves[i].side, Side::left);
      ASSERT_EQ(curves[i].cycles.size(), 1U) << "of the cycle that is on a plate";
      EXPECT_NEAR(curves[i].mean[30], expected[i], 1e-9) << curves[i].label << ", " << degrees;
      EXPECT_NEAR(curves[i].mean[80], 0, 1e-9) << "while it swings";
    }
  }
}

TEST(ForceCurves, NeedAWholeContactOfTheCyclesOwnFoot) {
  Walk walk({1, 0});
  EXPECT_EQ(cycles_on_plates(walk.forces, walk.cycles).size(), 1U);
  walk.forces.contacts[0].off_s.reset();
  EXPECT_TRUE(cycles_on_plates(walk.forces, walk.cycles).empty());
  walk.forces.contacts[0].off_s = 1.6;  // into the next cycle: both feet, or a wrong event
  EXPECT_TRUE(cycles_on_plates(walk.forces, walk.cycles).empty());
  walk.forces.contacts[0].off_s = 1.1;
  walk.forces.contacts[0].side.reset();
  EXPECT_TRUE(ground_reaction_curves(walk.forces, -0.1, walk.cycles, walk.sacrum, kMarkerRate).empty());
}

}  // namespace
}  // namespace marey::analyse::gait
