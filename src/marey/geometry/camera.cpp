#include "marey/geometry/camera.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <ceres/jet.h>

namespace marey::geometry {
namespace {

/// Distorted radius of a ray at `x` (tangent of its angle to the axis; the angle itself for a fisheye), tangential terms omitted.
double radius(const BrownLens& lens, double x) {
  const auto& k = lens.distortion;
  const double r2 = x * x;
  return x * (1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]))) / (1 + r2 * (k[5] + r2 * (k[6] + r2 * k[7])));
}

double radius(const FisheyeLens& lens, double x) {
  const auto& k = lens.distortion;
  const double r2 = x * x;
  return x * (1 + r2 * (k[0] + r2 * (k[1] + r2 * (k[2] + r2 * k[3]))));
}

/// Up to where the distorted radius grows with the undistorted one: beyond, two directions would share a pixel.
template <typename Model>
double widest(const Model& lens, double end) {
  constexpr int steps = 2000;
  double last = 0;
  for (int i = 1; i <= steps; ++i) {
    const double x = end * i / steps;
    const double here = radius(lens, x);
    if (!(here > last)) return end * (i - 1) / steps;
    last = here;
  }
  return end;
}

constexpr double kMaxTangent = 20;  // 87°: nothing flat is seen further aside

double widest(const BrownLens& lens) {
  return widest(lens, kMaxTangent);
}
double widest(const FisheyeLens& lens) {
  return widest(lens, std::numbers::pi);
}

/// undistorted(d) = d (1 + κ d²) grows up to d² = -1 / 3κ.
double widest(const TsaiLens& lens) {
  const double k = lens.distortion[0];
  return k < 0 ? std::min(kMaxTangent, 2.0 / 3.0 / std::sqrt(-3 * k)) : kMaxTangent;
}

template <typename T>
Eigen::Matrix<T, 2, 1> pixel_of(const Lens& lens, const Eigen::Matrix<T, 3, 1>& in_camera) {
  return std::visit(
      [&](const auto& model) -> Eigen::Matrix<T, 2, 1> {
        std::array<T, std::decay_t<decltype(model)>::coefficients> k;
        for (std::size_t i = 0; i < k.size(); ++i) k[i] = T(model.distortion[i]);
        const Eigen::Matrix<T, 2, 1> at = model.distort(in_camera, k.data());
        return {T(model.principal.x()) + T(model.focal.x()) * at.x(), T(model.principal.y()) + T(model.focal.y()) * at.y()};
      },
      lens);
}

constexpr int kMaxSteps = 50;
constexpr double kCloseEnough = 1e-14;

/// Newton's method for the undistorted place whose distorted one is `d`, steps halved where they lead away.
std::optional<Vector<3>> undistort(const BrownLens& lens, const Vector<2>& d, double end) {
  using Jet = ceres::Jet<double, 2>;
  std::array<Jet, BrownLens::coefficients> k;
  for (std::size_t i = 0; i < k.size(); ++i) k[i] = Jet(lens.distortion[i]);
  const auto distorted = [&](const Vector<2>& u) {
    return BrownLens::distort(Eigen::Matrix<Jet, 3, 1>(Jet(u.x(), 0), Jet(u.y(), 1), Jet(1)), k.data());
  };
  Vector<2> u = d;
  if (u.norm() > end) u *= end / u.norm();
  double off = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMaxSteps; ++i) {
    const auto at = distorted(u);
    const Vector<2> error(at.x().a - d.x(), at.y().a - d.y());
    off = error.norm();
    if (off < kCloseEnough) break;
    Matrix<2> J;
    J << at.x().v.transpose(), at.y().v.transpose();
    const double determinant = J.determinant();
    if (!(std::abs(determinant) > 1e-12)) return std::nullopt;
    Vector<2> step = J.inverse() * error;
    // A step that would leave where the model is one-to-one is shortened.
    while ((u - step).norm() > end && step.norm() > kCloseEnough) step /= 2;
    if (step.norm() < kCloseEnough) break;
    u -= step;
  }
  if (!(off < 1e-9)) return std::nullopt;
  return Vector<3>(u.x(), u.y(), 1);
}

std::optional<Vector<3>> undistort(const FisheyeLens& lens, const Vector<2>& d, double end) {
  const double required = d.norm();
  if (required < kCloseEnough) return Vector<3>(d.x(), d.y(), 1);
  if (required > radius(lens, end)) return std::nullopt;
  double low = 0, high = end;  // Newton's method kept within a bracket
  double angle = std::min(required, end);
  const auto& k = lens.distortion;
  for (int i = 0; i < kMaxSteps; ++i) {
    const double error = radius(lens, angle) - required;
    if (std::abs(error) < kCloseEnough) break;
    (error > 0 ? high : low) = angle;
    const double a2 = angle * angle;
    const double slope = 1 + a2 * (3 * k[0] + a2 * (5 * k[1] + a2 * (7 * k[2] + a2 * 9 * k[3])));
    const double next = angle - error / slope;
    angle = next > low && next < high ? next : (low + high) / 2;
  }
  const Vector<2> aside = d / required * std::sin(angle);
  return Vector<3>(aside.x(), aside.y(), std::cos(angle));
}

std::optional<Vector<3>> undistort(const TsaiLens& lens, const Vector<2>& d, double) {
  const double k = lens.distortion[0], r2 = d.squaredNorm();
  if (k < 0 && r2 > -1 / (3 * k)) return std::nullopt;
  const Vector<2> u = d * (1 + k * r2);
  return Vector<3>(u.x(), u.y(), 1);
}

}  // namespace

Camera::Camera(const Lens& lens, const Rigid3& camera_from_world, cv::Size size)
    : lens_(lens),
      camera_from_world_(camera_from_world),
      size_(size),
      centre_(camera_from_world.inverse().translation),
      widest_(std::visit([](const auto& model) { return widest(model); }, lens)),
      ahead_only_(ahead_only(lens)) {}

bool Camera::visible(const Vector<3>& in_camera) const {
  const double aside = in_camera.head<2>().norm();
  if (!ahead_only_) {
    return (aside > 0 || in_camera.z() > 0) && std::atan2(aside, in_camera.z()) <= widest_;
  }
  return in_camera.z() > 0 && aside <= widest_ * in_camera.z();
}

std::optional<Vector<2>> Camera::project(const Vector<3>& world) const {
  const Vector<3> in_camera = camera_from_world_ * world;
  if (!visible(in_camera)) return std::nullopt;
  return pixel_of<double>(lens_, in_camera);
}

std::optional<Camera::Projection> Camera::project_with_jacobian(const Vector<3>& world) const {
  using Jet = ceres::Jet<double, 3>;
  const Vector<3> in_camera = camera_from_world_ * world;
  if (!visible(in_camera)) return std::nullopt;
  const auto at =
      pixel_of<Jet>(lens_, Eigen::Matrix<Jet, 3, 1>(Jet(in_camera.x(), 0), Jet(in_camera.y(), 1), Jet(in_camera.z(), 2)));
  Eigen::Matrix<double, 2, 3> by_camera;
  by_camera << at.x().v.transpose(), at.y().v.transpose();
  return Projection{{at.x().a, at.y().a}, by_camera * camera_from_world_.rotation};
}

std::optional<Vector<3>> Camera::bearing(const Vector<2>& pixel) const {
  return std::visit(
      [&](const auto& model) -> std::optional<Vector<3>> {
        const auto at = undistort(model, (pixel - model.principal).cwiseQuotient(model.focal), widest_);
        if (!at) return std::nullopt;
        return at->normalized();
      },
      lens_);
}

std::optional<Ray> Camera::ray(const Vector<2>& pixel) const {
  const auto ahead = bearing(pixel);
  if (!ahead) return std::nullopt;
  return Ray{centre_, camera_from_world_.rotation.transpose() * *ahead};
}

}  // namespace marey::geometry
