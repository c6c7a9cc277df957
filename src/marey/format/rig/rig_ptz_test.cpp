#include "marey/format/rig/rig_ptz.h"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <gtest/gtest.h>

namespace marey::format::rig {
namespace {

/// Correlated as a tripod's error correlates pan with ln f.
Matrix<3> correlated(double pan, double tilt, double zoom, double pan_zoom) {
  Matrix<3> covariance = Vector<3>(pan * pan, tilt * tilt, zoom * zoom).asDiagonal();
  covariance(0, 2) = covariance(2, 0) = pan_zoom * pan * zoom;
  covariance(0, 1) = covariance(1, 0) = -0.3 * pan * tilt;
  covariance(1, 2) = covariance(2, 1) = 0.2 * tilt * zoom;
  return covariance;
}

/// How much larger a covariance says errors are than another, in the direction in which they differ most.
double largest_ratio(const Matrix<3>& a, const Matrix<3>& b) {
  const Matrix<3> root = b.llt().matrixL();
  const Matrix<3> whitened = root.inverse() * a * root.inverse().transpose();
  return whitened.selfadjointView<Eigen::Lower>().eigenvalues().cwiseMax(0).maxCoeff();
}

TEST(RigTurns, BothCovariancesOfAFrameAreReadAsTheyWereWritten) {
  const cv::Size size(1280, 720);
  PtzCamera camera;
  camera.rotations.push_back(
      {0, geometry::Heading{0.3, 0.2, 1.1}, correlated(2e-3, 7e-4, 9e-3, 0.8), correlated(1e-4, 2e-4, 3e-4, -0.5)});
  camera.rotations.push_back({0.04, std::nullopt, Matrix<3>::Zero(), std::nullopt});
  camera.rotations.push_back(
      {0.08, geometry::Heading{0.31, 0.2, 1.1}, correlated(3e-3, 7e-4, 9e-3, 0.9), correlated(2e-4, 2e-4, 3e-4, 0.9)});
  const auto read = parse_ptz(ptz_text(camera, size), "turns.csv", size);
  ASSERT_EQ(read.size(), 3u);
  EXPECT_FALSE(read[1].heading);
  for (const std::size_t i : {std::size_t{0}, std::size_t{2}}) {
    ASSERT_TRUE(read[i].heading && read[i].position_covariance) << i;
    const PtzCamera::Turn& turn = camera.rotations[i];
    EXPECT_LT((read[i].heading->as_vector() - turn.heading->as_vector()).norm(), 1e-6);
    for (const double ratio :
         {largest_ratio(read[i].covariance, turn.covariance), largest_ratio(turn.covariance, read[i].covariance),
          largest_ratio(*read[i].position_covariance, *turn.position_covariance),
          largest_ratio(*turn.position_covariance, *read[i].position_covariance)})
      EXPECT_NEAR(ratio, 1, 0.03) << i;
  }
}

TEST(RigTurns, StrongCorrelationsAreNotRoundedToCertainty) {
  const cv::Size size(1280, 720);
  PtzCamera camera;
  camera.rotations.push_back(
      {0, geometry::Heading{0.3, 0.2, 1.1}, correlated(2e-3, 7e-4, 9e-3, 0.93), Matrix<3>::Identity() * 1e-8});
  Matrix<3>& covariance = camera.rotations[0].covariance;
  covariance << 4e-6, 0, 1.79997e-5, 0, 5e-7, 0, 1.79997e-5, 0, 8.1e-5;  // pan and ln f: correlation 0.99998
  const auto read = parse_ptz(ptz_text(camera, size), "turns.csv", size);
  EXPECT_NEAR(largest_ratio(covariance, read[0].covariance), 1, 0.1);
}

TEST(RigTurns, WithoutPlacesTheFileHasTheFirstSixColumnsAlone) {
  const cv::Size size(1280, 720);
  PtzCamera camera;
  camera.rotations.push_back({0, geometry::Heading{0.3, 0.2, 1.1}, correlated(2e-3, 7e-4, 9e-3, 0.8), std::nullopt});
  const std::string text = ptz_text(camera, size);
  EXPECT_EQ(text.find("place"), std::string::npos);
  const auto read = parse_ptz(text, "turns.csv", size);
  ASSERT_EQ(read.size(), 1u);
  EXPECT_FALSE(read[0].position_covariance);
  EXPECT_NEAR(largest_ratio(read[0].covariance, camera.rotations[0].covariance), 1, 0.03);
}

}  // namespace
}  // namespace marey::format::rig
