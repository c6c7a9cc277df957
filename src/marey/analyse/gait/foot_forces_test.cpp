#include "marey/analyse/gait/foot_forces.h"

#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "marey/core/error.h"

namespace marey::analyse::gait {
namespace {

constexpr unsigned kSeed = 38;
constexpr double kRate = 1000, kFeetRate = 100, kBegin = 2.5, kLength = 3;

/// 0.5 m × 0.6 m, its middle at (x, y), C3D's order: z down.
ForcePlate plate_at(double x, double y) {
  ForcePlate plate;
  plate.name = "plate";
  plate.corners = {Vector<3>(x + 0.25, y - 0.3, 0), Vector<3>(x - 0.25, y - 0.3, 0), Vector<3>(x - 0.25, y + 0.3, 0),
                   Vector<3>(x + 0.25, y + 0.3, 0)};
  plate.rate_hz = kRate;
  plate.begin_s = kBegin;
  plate.loads.resize(static_cast<std::size_t>(kLength * kRate));
  return plate;
}

/// One step: a foot that stands on its heel's place from `begin` to `end` (s from the first row).
struct Step {
  Side side;
  double begin, end;
  Vector<3> heel;
};

/// A person who walks along x. Each foot stands still during its steps and moves between them.
class SimulatedWalk {
 public:
  explicit SimulatedWalk(std::vector<Step> steps) : steps_(std::move(steps)), random_(kSeed) {
    for (const Side side : kSides) {
      for (int r = 0; r < kLength * kFeetRate; ++r) {
        const Vector<3> heel = heel_at(side, r / kFeetRate);
        feet_.heel[static_cast<std::size_t>(side)].push_back(heel + Vector<3>(0, 0, 0.05));
        feet_.toe[static_cast<std::size_t>(side)].push_back(heel + Vector<3>(0.18, 0, 0.05));
      }
    }
  }

  /// A double bump of up to 700 N that moves from heel to toe, with a free moment of 5 N m. `noise` N.
  void load(ForcePlate& plate, double noise = 0.5) {
    std::normal_distribution<double> any(0, noise);
    for (std::size_t s = 0; s < plate.loads.size(); ++s) {
      const double time = static_cast<double>(s) / kRate;
      PlateLoad& load = plate.loads[s];
      load.force = {any(random_), any(random_), any(random_)};
      load.moment = {0.1 * any(random_), 0.1 * any(random_), 0.1 * any(random_)};
      for (const Step& step : steps_) {
        if (time < step.begin || time > step.end) continue;
        const Vector<3> arm = pressure(step, time) - plate.centre();
        if (std::abs(arm.x()) > 0.25 || std::abs(arm.y()) > 0.3) continue;
        const Vector<3> force = force_at(step, time);
        load.force += force;
        load.moment += arm.cross(force) + Vector<3>(0, 0, 5);
      }
    }
  }

  static double fraction(const Step& step, double time) { return (time - step.begin) / (step.end - step.begin); }
  static Vector<3> force_at(const Step& step, double time) {
    const double s = fraction(step, time);
    return {-100 * std::cos(std::numbers::pi * s) * std::sin(std::numbers::pi * s), 20,
            700 * (std::sin(std::numbers::pi * s) + 0.3 * std::sin(3 * std::numbers::pi * s))};
  }
  static Vector<3> pressure(const Step& step, double time) {
    return step.heel + Vector<3>(0.02 + 0.15 * fraction(step, time), 0.01, 0);
  }

  const FeetPaths& feet() const { return feet_; }

 private:
  Vector<3> heel_at(Side side, double time) const {
    const Step *before = nullptr, *after = nullptr;
    for (const Step& step : steps_) {
      if (step.side != side) continue;
      if (step.begin <= time) before = &step;
      if (step.begin > time && after == nullptr) after = &step;
    }
    if (before == nullptr)
      return after == nullptr ? Vector<3>(-5, 0.5, 0) : Vector<3>(after->heel - Vector<3>(2 * (after->begin - time), 0, 0));
    if (time <= before->end) return before->heel;
    if (after == nullptr) return before->heel + Vector<3>(2 * (time - before->end), 0, 0);
    const double s = (time - before->end) / (after->begin - before->end);
    return before->heel + s * (after->heel - before->heel);
  }

  std::vector<Step> steps_;
  FeetPaths feet_;
  std::mt19937 random_;
};

std::vector<Step> two_steps() {
  return {{Side::left, 0.5, 1.2, {-0.1, 0.1, 0}}, {Side::right, 1.1, 1.8, {0.55, -0.1, 0}}};
}

/// The largest differences of the result from the truth, over one foot's samples: N, m, N m.
std::array<double, 3> differences(const FootForces& forces, const Step& step) {
  std::array<double, 3> worst{};
  const auto& foot = forces.feet[static_cast<std::size_t>(step.side)];
  for (std::size_t s = 0; s < foot.size(); ++s) {
    const double time = static_cast<double>(s) / kRate;
    if (!foot[s] || foot[s]->force.z() < 100) continue;
    worst[0] = std::max(worst[0], (foot[s]->force - SimulatedWalk::force_at(step, time)).norm());
    worst[1] = std::max(worst[1], (foot[s]->pressure - SimulatedWalk::pressure(step, time)).norm());
    worst[2] = std::max(worst[2], std::abs(foot[s]->free_moment - 5));
  }
  return worst;
}

class FootForcesTest : public testing::Test {
 protected:
  FootForcesTest() : walk_(two_steps()), plates_{plate_at(0, 0), plate_at(0.6, 0)} {
    for (ForcePlate& plate : plates_) walk_.load(plate);
  }
  FootForces found() const { return foot_forces(plates_, walk_.feet(), kFeetRate, kBegin); }

  void expect_truth(const FootForces& forces, double force_n = 4, double pressure_m = 0.006) const {
    ASSERT_EQ(forces.contacts.size(), 2U);
    EXPECT_EQ(forces.contacts[0].side, Side::left);
    EXPECT_EQ(forces.contacts[1].side, Side::right);
    for (const Step& step : two_steps()) {
      const auto worst = differences(forces, step);
      EXPECT_LT(worst[0], force_n) << "seed " << kSeed;
      EXPECT_LT(worst[1], pressure_m);
      EXPECT_LT(worst[2], 2);
    }
    ASSERT_EQ(forces.events.size(), 4U);
    EXPECT_TRUE(forces.events[0].strike);
    EXPECT_EQ(forces.events[0].side, Side::left);
    const std::array<double, 4> times = {0.5, 1.1, 1.2, 1.8};  // 20 N come 3 ms after the beginning
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(forces.events[i].time_s, times[i], 0.006) << i;
  }

  SimulatedWalk walk_;
  std::vector<ForcePlate> plates_;
};

TEST_F(FootForcesTest, FindsFeetForcesPressureAndFreeMoment) {
  const FootForces forces = found();
  expect_truth(forces);
  EXPECT_TRUE(forces.warnings.empty()) << forces.warnings.front();
}

TEST_F(FootForcesTest, RemovesOffsetAndDrift) {
  for (std::size_t s = 0; s < plates_[0].loads.size(); ++s) {
    const double fraction = static_cast<double>(s) / static_cast<double>(plates_[0].loads.size());
    plates_[0].loads[s].force += Vector<3>(3, -4, 15 + 25 * fraction);
    plates_[0].loads[s].moment += Vector<3>(2, 1 - 3 * fraction, 0.5);
  }
  const FootForces forces = found();
  expect_truth(forces);
  ASSERT_EQ(forces.warnings.size(), 1U);
  EXPECT_NE(forces.warnings[0].find("while nothing is on it; removed"), std::string::npos) << forces.warnings[0];
}

TEST_F(FootForcesTest, ReversesPlatesThatPull) {
  for (PlateLoad& load : plates_[1].loads) load = {-load.force, -load.moment};
  const FootForces forces = found();
  expect_truth(forces);
  ASSERT_EQ(forces.warnings.size(), 1U);
  EXPECT_NE(forces.warnings[0].find("pull"), std::string::npos) << forces.warnings[0];
}

TEST_F(FootForcesTest, ReadsUpsideDownCornersInTheOrderOfTheFeet) {
  // Loads as the plate has them, in its axes: wrong corners give wrong axes.
  for (const std::array<std::size_t, 4> order : {std::array<std::size_t, 4>{1, 0, 3, 2}, {3, 2, 1, 0}, {2, 3, 0, 1}}) {
    const Matrix<3> axes = plates_[0].axes();
    std::vector<ForcePlate> wrong = plates_;
    for (std::size_t c = 0; c < 4; ++c) wrong[0].corners[c] = plates_[0].corners[order[c]];
    const Matrix<3> turned = wrong[0].axes() * axes.transpose();
    for (PlateLoad& load : wrong[0].loads) load = {turned * load.force, turned * load.moment};
    const FootForces forces = foot_forces(wrong, walk_.feet(), kFeetRate, kBegin);
    expect_truth(forces);
    ASSERT_EQ(forces.warnings.size(), 1U);
    EXPECT_NE(forces.warnings[0].find("corners"), std::string::npos) << forces.warnings[0];
  }
}

TEST_F(FootForcesTest, SaturatedContactsAreNotUsed) {
  plates_[0].saturated.assign(plates_[0].loads.size(), 0);
  std::fill_n(plates_[0].saturated.begin() + 800, 50, 1);
  const FootForces forces = found();
  ASSERT_EQ(forces.contacts.size(), 2U);
  EXPECT_FALSE(forces.contacts[0].side);
  EXPECT_EQ(forces.contacts[0].reason, "it is saturated");
  EXPECT_EQ(forces.contacts[1].side, Side::right);
}

TEST_F(FootForcesTest, BothFeetOnAPlateBelongToNone) {
  SimulatedWalk walk({{Side::left, 0.5, 1.4, {-0.1, 0.1, 0}}, {Side::right, 0.9, 1.8, {0.0, -0.1, 0}}});
  std::vector<ForcePlate> plates = {plate_at(0, 0)};
  walk.load(plates[0]);
  const FootForces forces = foot_forces(plates, walk.feet(), kFeetRate, kBegin);
  ASSERT_EQ(forces.contacts.size(), 1U);
  EXPECT_EQ(forces.contacts[0].reason, "both feet are on it");
  EXPECT_TRUE(forces.events.empty());
}

TEST_F(FootForcesTest, FeetOverAnEdgeAreNotUsed) {
  SimulatedWalk walk({{Side::left, 0.5, 1.2, {0.18, 0.1, 0}}, {Side::right, 1.1, 1.8, {0.9, -0.1, 0}}});
  std::vector<ForcePlate> plates = {plate_at(0, 0)};
  walk.load(plates[0]);
  const FootForces forces = foot_forces(plates, walk.feet(), kFeetRate, kBegin);
  ASSERT_EQ(forces.contacts.size(), 1U);
  EXPECT_EQ(forces.contacts[0].reason, "the left foot reaches over its edge");
}

TEST_F(FootForcesTest, SumsAFootOnTwoPlates) {
  // The same step, half of its force on each of two plates that lie on one another.
  std::vector<ForcePlate> plates = {plates_[0], plates_[0]};
  for (ForcePlate& plate : plates) {
    for (PlateLoad& load : plate.loads) load = {load.force / 2, load.moment / 2};
  }
  plates.push_back(plates_[1]);
  const FootForces forces = foot_forces(plates, walk_.feet(), kFeetRate, kBegin);
  ASSERT_EQ(forces.contacts.size(), 3U);
  const auto worst = differences(forces, two_steps()[0]);
  EXPECT_LT(worst[0], 4);
  EXPECT_LT(worst[1], 0.006);
  EXPECT_LT(worst[2], 2);
  EXPECT_EQ(forces.events.size(), 4U);
}

TEST_F(FootForcesTest, PlatesOfTwoRatesAreRefused) {
  plates_[1].rate_hz = 500;
  EXPECT_THROW(found(), Error);
}

TEST_F(FootForcesTest, ForceEventsReplaceTheNearestOfTheirKind) {
  const std::vector<GaitEvent> kinematic = {
      {Side::left, true, 0.49, 0.014}, {Side::left, false, 1.23, 0.014}, {Side::right, true, 3, 0.014}};
  const PreferredEvents preferred = prefer_forces(kinematic, found().events);
  ASSERT_EQ(preferred.events.size(), 5U) << "two replaced, one kept, two added";
  EXPECT_EQ(preferred.added, 2U);
  EXPECT_EQ(preferred.strikes.count, 1U);
  EXPECT_NEAR(preferred.strikes.mean_s, -0.013, 0.003);
  EXPECT_NEAR(preferred.offs.mean_s, 0.033, 0.003);
  EXPECT_EQ(preferred.events.back().time_s, 3);
}

}  // namespace
}  // namespace marey::analyse::gait
