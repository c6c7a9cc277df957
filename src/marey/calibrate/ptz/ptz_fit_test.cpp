#include "marey/calibrate/ptz/ptz_fit.h"

#include <random>

#include <gtest/gtest.h>

namespace marey::calibrate::ptz {
namespace {

const cv::Size kSize(1280, 720);
const geometry::Tripod kTripod{{50, -24, 13}, {}, 0, 0.2, 0.01};
const geometry::Heading kTruth{0.5, 0.21, 0.9};

/// Paint of every line in view, `share` of it elsewhere as people's socks are.
std::vector<PaintSighting> painted(double noise, double fraction, std::mt19937& random) {
  std::normal_distribution<double> gauss;
  std::uniform_real_distribution<double> even(0, 1);
  const Camera camera = geometry::camera_of(kTripod, kTruth, kSize);
  std::vector<PaintSighting> paint;
  const auto lines = geometry::pitch_lines({}, 1);
  for (std::size_t line = 0; line < lines.size(); ++line) {
    for (std::size_t i = 0; i < lines[line].points.size(); ++i) {
      const Vector<2>& at = lines[line].points[i];
      const auto detected = camera.project_with_jacobian({at.x(), at.y(), 0});
      if (!detected || !camera.in_image(detected->pixel)) continue;
      const Vector<2> along = (detected->by_world.leftCols<2>() * lines[line].tangents[i]).normalized(),
                      normal(-along.y(), along.x());
      const double off = even(random) < fraction ? 12 * (even(random) - 0.5) : noise * gauss(random);
      const Vector<2> pixel = detected->pixel + off * normal;
      paint.push_back({at.cast<float>(), pixel.cast<float>(), normal.cast<float>(), 0.5F, static_cast<std::int16_t>(line)});
    }
  }
  return paint;
}

TEST(Aim, PaintTellsPanTiltAndZoomDespiteOutliers) {
  std::mt19937 random(3);
  const Aim expected{{kTruth.pan + 0.002, kTruth.tilt - 0.002, kTruth.log_focal + 0.01},
                     Vector<3>(1e-4, 1e-4, 1e-3).asDiagonal().toDenseMatrix()};
  const AimFit fit = solve_aim(kTripod, kSize, painted(0.4, 0.25, random), expected);
  EXPECT_NEAR(fit.aim.heading.pan, kTruth.pan, 2e-4);
  EXPECT_NEAR(fit.aim.heading.tilt, kTruth.tilt, 2e-4);
  EXPECT_NEAR(fit.aim.heading.log_focal, kTruth.log_focal, 2e-3);
  EXPECT_GE(fit.lines, 3);
}

TEST(Aim, WithoutPaintItIsAsExpected) {
  const Aim expected{kTruth, Vector<3>(1e-4, 1e-4, 1e-3).asDiagonal().toDenseMatrix()};
  const AimFit fit = solve_aim(kTripod, kSize, {}, expected);
  EXPECT_NEAR(fit.aim.heading.pan, kTruth.pan, 1e-12);
  EXPECT_LT((fit.aim.covariance - expected.covariance).norm(), 1e-9);
}

TEST(Aim, TheJacobianIsThatOfTheCamera) {
  const Vector<3> location(80, 30, 0);
  const auto jacobian = pixel_by_heading(kTripod, kTruth, kSize, location);
  for (int i = 0; i < 3; ++i) {
    constexpr double kStep = 1e-6;
    const auto at = [&](double step) {
      Vector<3> moved = kTruth.as_vector();
      moved(i) += step;
      return *geometry::camera_of(kTripod, geometry::Heading::of(moved), kSize).project(location);
    };
    EXPECT_LT(((at(kStep) - at(-kStep)) / (2 * kStep) - jacobian.col(i)).norm(), 1e-3) << i;
  }
}

}  // namespace
}  // namespace marey::calibrate::ptz
