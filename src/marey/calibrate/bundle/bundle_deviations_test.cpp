#include "marey/calibrate/bundle/bundle_deviations.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "marey/calibrate/board/board_scene_test.h"

namespace marey::calibrate::bundle {
namespace {

using board::Noise;

/// Three cameras round wands; the first camera's pose is the frame.
Bundle three_cameras(Noise& noise, int wands) {
  Bundle bundle;
  bundle.wand = {0, 0.12, 0.30};
  for (int c = 0; c < 3; ++c) {
    const double angle = 2 * M_PI * c / 3;
    bundle.cameras.push_back({geometry::BrownLens{{1000, 1000}, {640, 512}, {}},
                              board::facing({3 * std::cos(angle), 3 * std::sin(angle), 1.5}, {0, 0, 0})});
    bundle.cameras.back().refine_pose = c > 0;
  }
  for (int b = 0; b < wands; ++b) {
    bundle.bodies.emplace_back(WandPose{board::in_cube(noise, 0.7), board::in_cube(noise, 1).normalized()});
    for (int c = 0; c < 3; ++c) {
      for (int m = 0; m < 3; ++m) bundle.observations.push_back({c, b, m});
    }
  }
  for (auto& detected : bundle.observations) detected.pixel = predicted_pixel(bundle, detected).value();
  return bundle;
}

std::vector<char> all_of(const Bundle& bundle) {
  return std::vector<char>(bundle.observations.size(), 1);
}

/// The slow twin: the centre itself, moved numerically.
TEST(BundleDeviations, TheCentresDerivativesAreThoseOfDifferences) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    Noise noise(seed);
    const Vector<3> turn = board::in_cube(noise, 1.5), shift = board::in_cube(noise, 3);
    const auto centre = [](const Eigen::Matrix<double, 6, 1>& p) {
      return Vector<3>(-(geometry::rotation_from(p.head<3>()).transpose() * p.tail<3>()));
    };
    Eigen::Matrix<double, 6, 1> pose;
    pose << turn, shift;
    const auto J = centre_by_pose({geometry::rotation_from(turn), shift});
    for (int k = 0; k < 6; ++k) {
      Eigen::Matrix<double, 6, 1> step = Eigen::Matrix<double, 6, 1>::Zero();
      step[k] = 1e-6;
      EXPECT_LT((J.col(k) - (centre(pose + step) - centre(pose - step)) / 2e-6).norm(), 1e-6) << k;
    }
  }
}

TEST(BundleDeviations, ALensesSigmasStandWhereItsNumbersDo) {
  const LensFreedom freedom{0.1, 0.02, 5, {0.3, 0.2, 0, 0.001}};
  const auto brown = lens_sigmas(geometry::BrownLens{{1000, 1000}, {640, 512}, {}}, freedom);
  ASSERT_EQ(brown.size(), 12U);
  EXPECT_NEAR(brown[0], 100, 1e-9) << "of 1000 px";
  EXPECT_NEAR(brown[1], 0.02, 1e-9);
  EXPECT_EQ(brown[2], 5);
  EXPECT_EQ(brown[3], 5);
  EXPECT_EQ(brown[4], 0.3);
  EXPECT_EQ(brown[6], 0) << "held";
  EXPECT_EQ(lens_sigmas(geometry::TsaiLens{{1000, 1000}, {640, 512}, {}}, freedom).size(), 5U) << "what it lacks is ignored";
}

TEST(BundleDeviations, FreeNumbersAreCounted) {
  Noise noise(1);
  Bundle bundle = three_cameras(noise, 10);
  EXPECT_EQ(free_numbers(bundle, all_of(bundle)), 2 * 6 + 10 * 5);
  bundle.cameras[1].freedom.focal = LensFreedom::free;
  bundle.cameras[2].refine_offset = true;
  EXPECT_EQ(free_numbers(bundle, all_of(bundle)), 2 * 6 + 10 * 5 + 2);
}

TEST(BundleDeviations, GrowWithNoiseShrinkWithDataAndAreZeroForTheFrame) {
  Noise noise(2);
  const Bundle few = three_cameras(noise, 20), many = three_cameras(noise, 80);
  const auto at = [](const Bundle& bundle, double px) { return deviations_of(bundle, bundle.cameras, all_of(bundle), px); };
  const auto once = at(few, 0.5), twice = at(few, 1), more = at(many, 0.5);
  EXPECT_EQ(once[0].centre, Vector<3>(0, 0, 0));
  EXPECT_EQ(once[0].rotation, Vector<3>(0, 0, 0));
  for (std::size_t c = 1; c < 3; ++c) {
    EXPECT_GT(once[c].centre.minCoeff(), 1e-5);
    EXPECT_LT(once[c].centre.maxCoeff(), 0.01);
    EXPECT_LT((twice[c].centre - 2 * once[c].centre).norm(), 1e-9);
    EXPECT_NEAR(more[c].centre.norm() / once[c].centre.norm(), 0.5, 0.2);
    EXPECT_EQ(once[c].focal, 0) << "held";
  }
}

TEST(BundleDeviations, AreWhatAdjustingNoisyPicturesShows) {
  Noise noise(3);
  const Bundle truth = three_cameras(noise, 25);
  const auto expected = deviations_of(truth, truth.cameras, all_of(truth), 0.5);
  constexpr int kTrials = 40;
  Vector<3> square = Vector<3>::Zero();
  for (int trial = 0; trial < kTrials; ++trial) {
    Bundle bundle = truth;
    for (auto& detected : bundle.observations) detected.pixel += Vector<2>(noise.gaussian(0.5), noise.gaussian(0.5));
    adjust(bundle, {.rounds = 0, .deviations = false});
    const Vector<3> off =
        bundle.cameras[1].camera_from_world.inverse().translation - truth.cameras[1].camera_from_world.inverse().translation;
    square += off.cwiseProduct(off) / kTrials;
  }
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(std::sqrt(square[axis]) / expected[1].centre[axis], 1, 0.4) << axis;
}

}  // namespace
}  // namespace marey::calibrate::bundle
