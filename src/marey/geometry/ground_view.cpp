#include "marey/geometry/ground_view.h"

#include <cmath>

#include <Eigen/LU>

namespace marey::geometry {
namespace {

std::optional<Vector<2>> plane_met(const Ray& ray) {
  const double down = -ray.direction.z() * (ray.origin.z() < 0 ? -1 : 1);  // towards the ground, from whichever side
  if (down <= 1e-9) return std::nullopt;
  return ray.origin.head<2>() + ray.direction.head<2>() * (std::abs(ray.origin.z()) / down);
}

// Newton's method from where the ray meets the plane: the ground's slopes are far less than the ray's, so that each step leaves a
// small share of the error. A ray that grazes the ground meets it nowhere that could be reported.
std::optional<Vector<2>> surface_met(const Ray& ray, const GroundSurface& surface) {
  constexpr int kSteps = 30;
  constexpr double kClose = 1e-9;  // m
  auto location = plane_met(ray);
  if (!location) return std::nullopt;
  const Vector<2> across = ray.direction.head<2>() / -ray.direction.z();  // m over the ground for each m that the ray sinks
  double height = 0;
  for (int step = 0; step < kSteps; ++step) {
    const double gap = surface.height(*location) - height;
    if (std::abs(gap) < kClose) return location;
    const double closing = 1 + surface.slope(*location).dot(across);
    if (!(closing > 0.05)) return std::nullopt;
    const double rise = gap / closing;
    height += rise;
    *location -= rise * across;
  }
  return std::nullopt;
}

// A homography has no sign. The foot of the image shows the ground before the camera: its weight is made positive.
Matrix<3> before_the_camera(const Matrix<3>& ground_from_image, cv::Size size) {
  const double weight = ground_from_image.row(2).dot(Vector<3>(size.width / 2.0, size.height, 1));
  return weight < 0 ? Matrix<3>(-ground_from_image) : ground_from_image;
}

}  // namespace

std::optional<Vector<2>> ground_met(const Ray& ray, const GroundSurface& surface) {
  return surface.flat() ? plane_met(ray) : surface_met(ray, surface);
}

GroundView::GroundView(const Matrix<3>& ground_from_image, cv::Size size)
    : view_(Homography{before_the_camera(ground_from_image, size), before_the_camera(ground_from_image, size).inverse(), size}) {}

cv::Size GroundView::size() const {
  if (const Camera* whole = camera()) return whole->size();
  return std::get<Homography>(view_).size;
}

const GroundSurface& GroundView::surface() const {
  static const GroundSurface level;
  const Whole* whole = std::get_if<Whole>(&view_);
  return whole ? whole->surface : level;
}

std::optional<GroundView::Location> GroundView::location(const Vector<2>& pixel) const {
  if (const Whole* whole = std::get_if<Whole>(&view_)) {
    const auto ray = whole->camera.ray(pixel);
    const auto ground = ray ? ground_met(*ray, whole->surface) : std::nullopt;
    if (!ground) return std::nullopt;
    const auto detected = whole->camera.project_with_jacobian({ground->x(), ground->y(), whole->surface.height(*ground)});
    if (!detected) return std::nullopt;
    Matrix<2> by_ground = detected->by_world.leftCols<2>();
    if (!whole->surface.flat()) by_ground += detected->by_world.col(2) * whole->surface.slope(*ground).transpose();
    if (!(std::abs(by_ground.determinant()) > 1e-12)) return std::nullopt;
    return Location{*ground, by_ground.inverse()};
  }
  const Matrix<3>& H = std::get<Homography>(view_).ground_from_image;
  const Vector<3> at = H * pixel.homogeneous();
  if (!(at.z() > 1e-12 * H.row(2).norm())) return std::nullopt;
  const Vector<2> ground = at.hnormalized();
  return Location{ground, (H.topLeftCorner<2, 2>() - ground * H.row(2).head<2>()) / at.z()};
}

std::optional<Vector<2>> GroundView::pixel(const Vector<2>& ground) const {
  if (const Whole* whole = std::get_if<Whole>(&view_))
    return whole->camera.project({ground.x(), ground.y(), whole->surface.height(ground)});
  const Homography& view = std::get<Homography>(view_);
  const Vector<3> at = view.image_from_ground * ground.homogeneous();
  // inverse(H) maps back to (pixel, 1) / weight: a positive last entry means a positive weight, thus before the camera.
  if (!(at.z() > 0)) return std::nullopt;
  return at.hnormalized();
}

}  // namespace marey::geometry
