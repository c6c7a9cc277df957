#pragma once

#include <optional>
#include <variant>

#include "marey/geometry/camera.h"

namespace marey::geometry {

/// How a view meets the ground, the plane z = 0 of the world: a whole camera, or a bare homography where nothing more is known.
class GroundView {
 public:
  explicit GroundView(const Camera& camera) : view_(camera) {}

  /// `ground_from_image`: (x, y, 1) in px to homogeneous ground coordinates in m; invertible, of any scale. `size` in px.
  GroundView(const Matrix<3>& ground_from_image, cv::Size size);

  struct Place {
    Vector<2> ground;    ///< m
    Matrix<2> by_pixel;  ///< ∂ground/∂pixel, m/px: far away a pixel is a metre
  };

  /// Where on the ground the thing stands whose foot is seen at `pixel`; nothing at or above the horizon.
  std::optional<Place> place(const Vector<2>& pixel) const;

  /// The pixel of a point of the ground; nothing where it lies behind the camera.
  std::optional<Vector<2>> pixel(const Vector<2>& ground) const;

  /// The whole camera, where it is known.
  const Camera* camera() const { return std::get_if<Camera>(&view_); }
  cv::Size size() const;

 private:
  struct Homography {
    Matrix<3> ground_from_image, image_from_ground;  // scaled so that what is before the camera has positive weight
    cv::Size size;
  };
  std::variant<Camera, Homography> view_;
};

}  // namespace marey::geometry
