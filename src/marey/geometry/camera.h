#pragma once

#include <optional>

#include <opencv2/core/types.hpp>

#include "marey/geometry/lens.h"
#include "marey/geometry/rigid.h"

namespace marey::geometry {

/// A half-line in the world, m. `direction` has length 1.
struct Ray {
  Vector<3> origin = Vector<3>::Zero();
  Vector<3> direction = Vector<3>::UnitZ();
};

/// A calibrated camera: lens, pose and image size. The camera's frame has x right, y down, z ahead.
class Camera {
 public:
  /// Focal lengths positive, `camera_from_world` a rigid motion; `size` in px, for those who ask whether a pixel is in the image.
  Camera(const Lens& lens, const Rigid3& camera_from_world, cv::Size size);

  const Lens& lens() const { return lens_; }
  const Rigid3& camera_from_world() const { return camera_from_world_; }
  cv::Size size() const { return size_; }
  const Vector<3>& centre() const { return centre_; }  ///< in the world, m

  /// The pixel of a point of the world, inside the image or not; nothing if the point lies behind the camera or so far
  /// aside that the lens model folds back.
  std::optional<Vector<2>> project(const Vector<3>& world) const;

  struct Projection {
    Vector<2> pixel;
    Eigen::Matrix<double, 2, 3> by_world;  ///< ∂pixel/∂world, px/m
  };
  std::optional<Projection> project_with_jacobian(const Vector<3>& world) const;

  /// Direction of length 1 in the camera's frame that is seen at `pixel`; nothing if the lens shows nothing there.
  std::optional<Vector<3>> bearing(const Vector<2>& pixel) const;

  /// The same as a half-line in the world.
  std::optional<Ray> ray(const Vector<2>& pixel) const;

  bool in_image(const Vector<2>& pixel) const {
    return pixel.x() >= -0.5 && pixel.y() >= -0.5 && pixel.x() < size_.width - 0.5 && pixel.y() < size_.height - 0.5;
  }

 private:
  bool visible(const Vector<3>& in_camera) const;

  Lens lens_;
  Rigid3 camera_from_world_;
  cv::Size size_;
  Vector<3> centre_;
  double widest_ = 0;       // up to which the lens model is one-to-one: tangent of the angle to the axis, or that angle, rad,
  bool ahead_only_ = true;  // where points beside and behind the camera have pixels too
};

}  // namespace marey::geometry
