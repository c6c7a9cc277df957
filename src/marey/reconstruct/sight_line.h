#pragma once

#include <cmath>
#include <optional>

#include "marey/core/geometry.h"
#include "marey/geometry/camera.h"

namespace marey::reconstruct {

/// What one seen pixel says of the world, in a form in which the reprojection error of a point costs a dozen multiplications
/// whatever the lens: the half-line behind the pixel, and how pixels change across it.
///
/// For a point x with p = x − origin the error in px is  across · p / (direction · p):  exact on the half-line and to first order
/// beside it, which for errors of a few px is all that can be known. Divided by the noise it is in standard deviations.
struct SightLine {
  int camera = 0;                            ///< number of the camera it belongs to
  Vector<3> origin = Vector<3>::Zero();      ///< the camera's centre, m
  Vector<3> direction = Vector<3>::UnitZ();  ///< of length 1
  Eigen::Matrix<double, 2, 3> across;        ///< ∂pixel/∂world at distance 1 on the half-line, px
  double sigma = 1;                          ///< standard deviation of the pixel along each axis, px

  /// Pixels a radian at the pixel, the mean of all directions.
  double scale() const { return std::sqrt(across.squaredNorm() / 2); }

  /// How far along the half-line `world` lies, m; not positive behind the camera.
  double depth(const Vector<3>& world) const { return direction.dot(world - origin); }

  /// Reprojection error of `world`, px: where it would be seen, less where it was. Needs a positive depth.
  Vector<2> error(const Vector<3>& world) const {
    const Vector<3> p = world - origin;
    return across * p / direction.dot(p);
  }
};

/// The half-line behind `pixel`, whose noise is `sigma` > 0 px along each axis; nothing if the lens shows nothing there.
std::optional<SightLine> sight_line(const Camera& camera, int number, const Vector<2>& pixel, double sigma);

}  // namespace marey::reconstruct
