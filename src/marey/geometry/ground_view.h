#pragma once

#include <optional>
#include <variant>

#include "marey/geometry/camera.h"
#include "marey/geometry/ground_surface.h"

namespace marey::geometry {

/// Where a ray meets the ground, from whichever side; nothing if it rises from it, or grazes it.
std::optional<Vector<2>> ground_met(const Ray& ray, const GroundSurface& surface);

/// How a view meets the ground, the plane z = 0 of the world or a surface near it: a whole camera, or a bare homography where
/// nothing more is known, which holds for whatever surface it was found on.
class GroundView {
 public:
  explicit GroundView(const Camera& camera, const GroundSurface& surface = {}) : view_(Whole{camera, surface}) {}

  /// `ground_from_image`: (x, y, 1) in px to homogeneous ground coordinates in m; invertible, of any scale. `size` in px.
  GroundView(const Matrix<3>& ground_from_image, cv::Size size);

  struct Location {
    Vector<2> ground;    ///< m
    Matrix<2> by_pixel;  ///< ∂ground/∂pixel, m/px: far away a pixel is a metre
  };

  /// Where on the ground the thing stands whose foot is seen at `pixel`; nothing at or above the horizon.
  std::optional<Location> location(const Vector<2>& pixel) const;

  /// The pixel of a point of the ground; nothing if it lies behind the camera.
  std::optional<Vector<2>> pixel(const Vector<2>& ground) const;

  /// The whole camera, where it is known.
  const Camera* camera() const {
    const Whole* whole = std::get_if<Whole>(&view_);
    return whole ? &whole->camera : nullptr;
  }
  /// The ground that the camera faces; level for a homography, which knows no heights.
  const GroundSurface& surface() const;
  cv::Size size() const;

 private:
  struct Whole {
    Camera camera;
    GroundSurface surface;
  };
  struct Homography {
    Matrix<3> ground_from_image, image_from_ground;  // scaled so that what is before the camera has positive weight
    cv::Size size;
  };
  std::variant<Whole, Homography> view_;
};

}  // namespace marey::geometry
