// A simulated leg that goes through its range of motion: its hip's centre and its knee's axis are known, and skin moves over them
// as it does on people (thigh 18 mm, shank 17 mm at the ends of the range: PMC8631460; of the pelvis 5 mm are assumed).
#include "marey/solve/skeleton/functional_joints.h"

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "marey/geometry/layout.h"

namespace marey::solve::skeleton {
namespace {

using geometry::Rigid3;
using geometry::rotation_from;

constexpr double kDegree = std::numbers::pi / 180;

/// The same for all runs: uniform in [−1, 1).
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : state_(seed * 2 + 1) {}
  double operator()() {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(state_ >> 11) / static_cast<double>(1ULL << 52) - 1;
  }
  Vector<3> vector() {
    const double x = (*this)(), y = (*this)();
    return {x, y, (*this)()};
  }

 private:
  std::uint64_t state_;
};

const Vector<3> kHip(-0.05, 0.09, -0.08);                           // in the pelvis
const Vector<3> kKnee(0, 0, -0.42);                                 // in the thigh
const Vector<3> kKneeAxis = Vector<3>(0.08, 1, 0.03).normalized();  // in the thigh

struct Leg {
  Rigid3 pelvis, thigh, shank;
  double flexion = 0, abduction = 0, rotation = 0, knee = 0;  // rad
};

/// 20 s at 100 Hz: the leg swings ahead, aside and round, the knee bends; `aside` is how far it goes but ahead.
Leg leg_at(double t, double aside) {
  Leg leg;
  leg.pelvis = {rotation_from({0.05 * std::sin(0.9 * t), 0.08 * std::sin(1.3 * t), 0.3 * std::sin(0.4 * t)}),
                {0.3 * std::sin(0.3 * t), 0.2 * std::cos(0.5 * t), 0.95}};
  leg.flexion = (15 + 30 * std::sin(2.1 * t)) * kDegree;
  leg.abduction = aside * 20 * std::sin(1.37 * t) * kDegree;
  leg.rotation = aside * 12 * std::sin(0.83 * t + 1) * kDegree;
  leg.knee = (40 + 35 * std::sin(1.7 * t)) * kDegree;
  leg.thigh = leg.pelvis * Rigid3{rotation_from({0, -leg.flexion, 0}) * rotation_from({leg.abduction, 0, 0}) *
                                      rotation_from({0, 0, leg.rotation}),
                                  kHip};
  leg.shank = leg.thigh * Rigid3{rotation_from(leg.knee * kKneeAxis), kKnee};
  return leg;
}

/// Markers on a segment, and how skin carries each of them along with the joints.
struct Cluster {
  std::vector<Vector<3>> locations;
  std::vector<Matrix<3>> carried;  // m at the ends of the range, by what moves

  Cluster(std::vector<Vector<3>> at, double skin_m, Draw& draw) : locations(std::move(at)) {
    const Matrix<3> together = skin_m * Matrix<3>{{draw(), draw(), draw()}, {draw(), draw(), draw()}, {draw(), draw(), draw()}};
    for (std::size_t i = 0; i < locations.size(); ++i) {
      Matrix<3> own;
      for (int k = 0; k < 3; ++k) own.col(k) = 0.5 * skin_m * draw.vector();
      carried.push_back((0.5 * together + own) / std::sqrt(2.0));
    }
  }
  std::vector<Vector<3>> detected(const Rigid3& world_from, const Vector<3>& moved, double noise_m, Draw& draw) const {
    std::vector<Vector<3>> detected;
    for (std::size_t i = 0; i < locations.size(); ++i)
      detected.push_back(world_from * (locations[i] + carried[i] * moved) + noise_m * draw.vector());
    return detected;
  }
};

struct Recorded {
  std::vector<std::optional<Rigid3>> pelvis, thigh, shank;
};

Recorded recorded(double skin, double noise_m, double aside, std::uint64_t seed) {
  Draw draw(seed);
  const Cluster pelvis({{0, 0.12, 0}, {0, -0.12, 0}, {-0.18, 0.04, 0.02}, {-0.18, -0.04, 0.02}}, 0.005 * skin, draw);
  const Cluster thigh({{0.02, 0.08, -0.2}, {0, 0.055, -0.42}, {0.07, 0.02, -0.25}, {0.05, 0.06, -0.12}}, 0.018 * skin, draw);
  const Cluster shank({{0.03, 0.04, -0.15}, {0, 0.04, -0.4}, {0.05, 0, -0.1}, {0.05, -0.01, -0.25}}, 0.017 * skin, draw);
  Recorded all;
  const auto add = [&](std::vector<std::optional<Rigid3>>& poses, const Cluster& cluster, const std::vector<Vector<3>>& detected) {
    poses.push_back(geometry::rigid_fit(cluster.locations, detected));
  };
  for (int i = 0; i < 2000; ++i) {
    const Leg leg = leg_at(i / 100.0, aside);
    const Vector<3> hip(leg.flexion / (45 * kDegree), leg.abduction / (20 * kDegree), leg.rotation / (12 * kDegree));
    const Vector<3> knee(leg.knee / (75 * kDegree), 0, 0);
    add(all.pelvis, pelvis, pelvis.detected(leg.pelvis, hip, noise_m, draw));
    add(all.thigh, thigh, thigh.detected(leg.thigh, hip, noise_m, draw));
    add(all.shank, shank, shank.detected(leg.shank, knee, noise_m, draw));
  }
  return all;
}

double degrees_off(const Vector<3>& direction) {
  return std::acos(std::min(1.0, std::abs(direction.dot(kKneeAxis)))) / kDegree;
}

TEST(FunctionalJoints, AreExactWhereNothingMoves) {
  const Recorded leg = recorded(0, 0, 1, 1);
  const auto hip = functional_centre(leg.pelvis, leg.thigh);
  ASSERT_TRUE(hip);
  EXPECT_LT((hip->in_parent - kHip).norm(), 1e-9);
  EXPECT_LT(hip->deviation_m, 1e-9);
  EXPECT_LT(hip->gap_m, 1e-9);
  const auto knee = functional_axis(leg.thigh, leg.shank);
  ASSERT_TRUE(knee);
  EXPECT_LT(degrees_off(knee->direction), 1e-5);
  EXPECT_LT((knee->point - kKnee).cross(kKneeAxis).norm(), 1e-9) << "a point of the axis";
  EXPECT_NEAR(knee->rotated_rad / kDegree, 70, 0.5);
}

/// The skin of 24 simulated people, with four markers a segment.
TEST(FunctionalJoints, BearSkinThatMoves) {
  constexpr int kPeople = 24;
  double hip_m2 = 0, said_m2 = 0, knee_deg = 0, said_deg = 0, knee_m = 0;
  for (std::uint64_t seed = 1; seed <= kPeople; ++seed) {
    const Recorded leg = recorded(1, 0.0005, 1, seed);
    const auto hip = functional_centre(leg.pelvis, leg.thigh);
    const auto knee = functional_axis(leg.thigh, leg.shank);
    ASSERT_TRUE(hip && knee) << seed;
    hip_m2 += (hip->in_parent - kHip).squaredNorm() / kPeople;
    said_m2 += hip->deviation_m * hip->deviation_m / kPeople;
    knee_deg += degrees_off(knee->direction) / kPeople;
    said_deg += knee->deviation_rad / kDegree / kPeople;
    knee_m += (knee->point - kKnee).cross(kKneeAxis).norm() / kPeople;
  }
  std::printf("hip %.1f mm RMS (said %.1f), knee's axis %.1f deg (said %.1f) and %.1f mm\n", 1000 * std::sqrt(hip_m2),
              1000 * std::sqrt(said_m2), knee_deg, said_deg, 1000 * knee_m);
  EXPECT_LT(std::sqrt(hip_m2), 0.020);
  EXPECT_NEAR(std::sqrt(said_m2), std::sqrt(hip_m2), 0.005) << "the deviation is of the error's size";
  EXPECT_LT(knee_deg, 4);
  EXPECT_LT(knee_m, 0.010);
}

/// A leg that swings ahead alone says nothing of where along that axis its hip is.
TEST(FunctionalJoints, SayWhatTheMotionDoesNotDetermine) {
  const Recorded still = recorded(1, 0.0005, 0, 3);
  const auto along = functional_centre(still.pelvis, still.thigh);
  EXPECT_TRUE(!along || along->deviation_m > 0.01) << "one axis alone: the skin decides";
  const Recorded exact = recorded(0, 0, 0, 3);
  EXPECT_FALSE(functional_centre(exact.pelvis, exact.thigh));
  const Recorded noisy = recorded(0, 0.0005, 1, 3);
  const auto hip = functional_centre(noisy.pelvis, noisy.thigh);
  ASSERT_TRUE(hip);
  EXPECT_LT((hip->in_parent - kHip).norm(), 0.001);
  EXPECT_LT((hip->in_parent - kHip).norm(), 5 * hip->deviation_m + 1e-4) << "the deviation is of the error's size";
  const std::vector<std::optional<Rigid3>> few(noisy.pelvis.begin(), noisy.pelvis.begin() + 20);
  EXPECT_FALSE(functional_centre(few, noisy.thigh));
  EXPECT_FALSE(functional_axis(noisy.thigh, noisy.thigh)) << "nothing turns";
}

}  // namespace
}  // namespace marey::solve::skeleton
