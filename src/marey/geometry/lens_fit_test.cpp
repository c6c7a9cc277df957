#include "marey/geometry/lens_fit.h"

#include <gtest/gtest.h>

#include "marey/geometry/camera.h"
#include "marey/geometry/rigid.h"

namespace marey::geometry {
namespace {

TEST(LensFit, FindsALensAndItsTurn) {
  BrownLens lens;
  lens.focal = {800, 810};
  lens.principal = {330, 250};
  lens.distortion = {-0.25, 0.08, 0.001, -0.002, 0.01};
  const Matrix<3> turn = rotation_from({0.02, -0.03, 0.05});
  const cv::Size size(640, 480);
  const Camera camera(lens, Rigid3{}, size);
  const auto direction = [&](const Vector<2>& pixel) -> std::optional<Vector<3>> {
    return Vector<3>(turn.transpose() * *camera.bearing(pixel));
  };
  BrownLens start;
  start.focal = {700, 700};
  start.principal = {319.5, 239.5};
  const auto fit = fit_brown(direction, size, start, {.coefficients = 5, .turn = false});
  EXPECT_GT(fit->rms_px, 0.5);
  // A turn and the principal point stand for each other but for the distortion: the pixels are found, and with them the rest.
  const auto rotated = fit_brown(direction, size, start, {.coefficients = 5, .turn = true});
  EXPECT_LT(rotated->rms_px, 1e-3);
  EXPECT_FALSE(fit_brown([](const Vector<2>&) { return std::optional<Vector<3>>(); }, size, start));
}

}  // namespace
}  // namespace marey::geometry
