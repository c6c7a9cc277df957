// The derivatives of whole residuals are held against differences in bundle_test.cpp.
#include "marey/calibrate/bundle/bundle_residual.h"

#include <array>
#include <memory>

#include <gtest/gtest.h>

#include "marey/calibrate/board/board_scene_test.h"

namespace marey::calibrate::bundle {
namespace {

using board::Noise;

const std::vector<geometry::Lens> kLenses{geometry::BrownLens{{900, 910}, {640, 480}, {-0.2, 0.05, 0.001, -0.001, 0.01}},
                                          geometry::FisheyeLens{{500, 505}, {640, 480}, {0.02, -0.01, 0.003, 0}},
                                          geometry::TsaiLens{{900, 905}, {640, 480}, {-0.1}}};

TEST(BundleResidual, NumbersComeBackAsTheyWere) {
  Noise noise(1);
  for (const geometry::Lens& lens : kLenses) {
    const auto numbers = numbers_of(lens);
    ASSERT_EQ(std::ssize(numbers), lens_numbers(lens));
    geometry::Lens other = lens;
    std::visit([](auto& model) { model.focal = {1, 1}, model.distortion = {}; }, other);
    set_numbers(other, numbers.data());
    EXPECT_LT((geometry::focal_of(other) - geometry::focal_of(lens)).norm(), 1e-9);
    const auto again = numbers_of(other);
    for (std::size_t i = 0; i < numbers.size(); ++i) EXPECT_NEAR(again[i], numbers[i], 1e-12) << i;
  }
  for (int i = 0; i < 20; ++i) {
    const Rigid3 pose{geometry::rotation_from(board::in_cube(noise, 1.7)), board::in_cube(noise, 5)};
    const Rigid3 back = pose_from(numbers_of(pose).data());
    EXPECT_LT((back.rotation - pose.rotation).norm() + (back.translation - pose.translation).norm(), 1e-9);
    for (const Body& body :
         {Body(Vector<3>(pose.translation)), Body(WandPose{pose.translation, pose.rotation.col(0)}), Body(pose)}) {
      Body copy = body;
      auto numbers = numbers_of(body);
      ASSERT_EQ(std::ssize(numbers), body_numbers(body));
      set_numbers(copy, numbers.data());
      const auto again = numbers_of(copy);
      for (std::size_t k = 0; k < numbers.size(); ++k) EXPECT_NEAR(again[k], numbers[k], 1e-9) << k;
    }
  }
}

TEST(BundleResidual, TheLeftJacobianIsThatOfDifferences) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    Noise noise(seed);
    const Vector<3> turn = seed == 1 ? Vector<3>(0, 0, 0) : board::in_cube(noise, 1.5), v = board::in_cube(noise, 2);
    const Vector<3> rotated = geometry::rotation_from(turn) * v;
    const Matrix<3> J = left_jacobian(turn);
    for (int k = 0; k < 3; ++k) {
      Vector<3> step = Vector<3>::Zero();
      step[k] = 1e-6;
      const Vector<3> difference = (geometry::rotation_from(turn + step) * v - geometry::rotation_from(turn - step) * v) / 2e-6;
      EXPECT_LT((Vector<3>(J.col(k)).cross(rotated) - difference).norm(), 1e-5) << k;
    }
  }
}

TEST(BundleResidual, TheErrorIsPredictedMinusSeen) {
  Noise noise(3);
  for (const geometry::Lens& lens : kLenses) {
    SCOPED_TRACE(geometry::name_of(lens));
    Bundle bundle;
    bundle.cameras.push_back({lens, {geometry::rotation_from({0.1, -0.2, 0.05}), {0.1, 0.2, 3}}});
    bundle.bodies.emplace_back(Vector<3>(0.2, -0.1, 0.3));
    const BundleObservation detected{0, 0, 0, {600, 500}, {30, -20}};
    const auto predicted = predicted_pixel(bundle, detected);
    const std::unique_ptr<ceres::CostFunction> cost(make_reprojection(lens, bundle.bodies[0], Vector<3>::Zero(), detected, true));
    const auto pose = numbers_of(bundle.cameras[0].camera_from_world), numbers = numbers_of(lens),
               body = numbers_of(bundle.bodies[0]);
    const double offset = 0.1;
    const std::array<const double*, 4> blocks{pose.data(), numbers.data(), body.data(), &offset};
    Vector<2> error;
    ASSERT_TRUE(cost->Evaluate(blocks.data(), error.data(), nullptr));
    EXPECT_LT((error - (*predicted - detected.pixel + 0.1 * detected.velocity)).norm(), 1e-9);
  }
}

TEST(BundleResidual, AMarkerBehindTheCameraCannotBeEvaluated) {
  const BundleObservation detected{0, 0, 0, {600, 500}};
  const Body body(Vector<3>(0, 0, -1));
  const std::unique_ptr<ceres::CostFunction> cost(make_reprojection(kLenses[0], body, Vector<3>::Zero(), detected, false));
  EXPECT_EQ(cost->parameter_block_sizes().size(), 3U);
  const auto pose = numbers_of(Rigid3{}), lens = numbers_of(kLenses[0]), location = numbers_of(body);
  const std::array<const double*, 3> blocks{pose.data(), lens.data(), location.data()};
  Vector<2> error;
  EXPECT_FALSE(cost->Evaluate(blocks.data(), error.data(), nullptr));
}

}  // namespace
}  // namespace marey::calibrate::bundle
