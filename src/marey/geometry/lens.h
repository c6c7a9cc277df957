// From a direction before the camera to a pixel: focal length, principal point and the distortion of three lens models.
//
//   brown    Brown-Conrady with OpenCV's rational extension: radial k1 … k6 and tangential p1, p2
//   fisheye  Kannala-Brandt: the angle to the axis is mapped by an odd polynomial, so that 90° and more are seen
//   tsai     Tsai 1987: one coefficient that leads from the distorted place to the undistorted one
//
// A new model is a struct here, named in Lens, and its inverse in camera.cpp: nothing compiles until that is there.
// Each model is one template on the scalar, so that a solver can differentiate it (ceres::Jet) and projection stays one piece of
// code. References: Brown, "Close-range camera calibration", 1971; Kannala & Brandt, "A generic camera model", PAMI 2006; Tsai, "A
// versatile camera calibration technique", 1987. Numbers agree with OpenCV's projectPoints and fisheye::projectPoints.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string_view>
#include <variant>

#include "marey/geometry/vector.h"

namespace marey::geometry {

/// Every model: pixel = principal + focal · distort(point), per axis. `focal` and `principal` are in px; the coefficients have no
/// unit. `ahead_only`: only points before the camera (z > 0) have a pixel.
struct BrownLens {
  static constexpr std::string_view name = "brown";
  static constexpr int coefficients = 8;
  static constexpr bool ahead_only = true;

  Vector<2> focal = Vector<2>::Ones();
  Vector<2> principal = Vector<2>::Zero();
  std::array<double, coefficients> distortion{};  ///< k1 k2 p1 p2 k3 k4 k5 k6: OpenCV's order

  /// `point` in the camera's frame (x right, y down, z ahead), z > 0; `k` as `distortion`.
  template <typename T>
  static Eigen::Matrix<T, 2, 1> distort(const Eigen::Matrix<T, 3, 1>& point, const T* k) {
    const T x = point.x() / point.z(), y = point.y() / point.z();
    const T r2 = x * x + y * y;
    const T radial = (T(1) + r2 * (k[0] + r2 * (k[1] + r2 * k[4]))) / (T(1) + r2 * (k[5] + r2 * (k[6] + r2 * k[7])));
    return {x * radial + T(2) * k[2] * x * y + k[3] * (r2 + T(2) * x * x),
            y * radial + k[2] * (r2 + T(2) * y * y) + T(2) * k[3] * x * y};
  }
};

struct FisheyeLens {
  static constexpr std::string_view name = "fisheye";
  static constexpr int coefficients = 4;
  static constexpr bool ahead_only = false;

  Vector<2> focal = Vector<2>::Ones();
  Vector<2> principal = Vector<2>::Zero();
  std::array<double, coefficients> distortion{};  ///< k1 … k4, of θ³ … θ⁹

  /// Any `point` but the origin; those behind the camera are beyond 90°.
  template <typename T>
  static Eigen::Matrix<T, 2, 1> distort(const Eigen::Matrix<T, 3, 1>& point, const T* k) {
    using std::atan2;
    using std::sqrt;
    const T r2 = point.x() * point.x() + point.y() * point.y();
    if (r2 <= T(1e-24) * point.z() * point.z()) return {point.x() / point.z(), point.y() / point.z()};
    const T r = sqrt(r2);
    const T angle = atan2(r, point.z());
    const T angle2 = angle * angle;
    const T factor = angle * (T(1) + angle2 * (k[0] + angle2 * (k[1] + angle2 * (k[2] + angle2 * k[3])))) / r;
    return {point.x() * factor, point.y() * factor};
  }
};

struct TsaiLens {
  static constexpr std::string_view name = "tsai";
  static constexpr int coefficients = 1;
  static constexpr bool ahead_only = true;

  Vector<2> focal = Vector<2>::Ones();
  Vector<2> principal = Vector<2>::Zero();
  std::array<double, coefficients> distortion{};  ///< κ1 · f²: undistorted = distorted · (1 + κ r²), r distorted, in focal lengths

  /// `point` with z > 0. The distorted radius is the root next to the undistorted one, by Newton's method.
  template <typename T>
  static Eigen::Matrix<T, 2, 1> distort(const Eigen::Matrix<T, 3, 1>& point, const T* k) {
    const T x = point.x() / point.z(), y = point.y() / point.z();
    const T r2 = x * x + y * y;
    T shrink = T(1);  // distorted = shrink · undistorted: shrink (1 + κ r² shrink²) = 1
    for (int i = 0; i < 12; ++i) {
      const T square = k[0] * r2 * shrink * shrink;
      shrink -= (shrink * (T(1) + square) - T(1)) / (T(1) + T(3) * square);
    }
    return {x * shrink, y * shrink};
  }
};

using Lens = std::variant<BrownLens, FisheyeLens, TsaiLens>;

/// The names of all models, in the order of the register.
std::span<const std::string_view> lens_names();

/// The lens of that name without distortion, focal length 1 px; nothing if there is no such model.
std::optional<Lens> lens_named(std::string_view name);

std::string_view name_of(const Lens& lens);
/// How many numbers its distortion has.
int coefficients_of(const Lens& lens);
bool ahead_only(const Lens& lens);
const Vector<2>& focal_of(const Lens& lens);
const Vector<2>& principal_of(const Lens& lens);

/// The same lens before a sensor read at `factor` times the resolution (integer pixel coordinates are centres, so that the
/// principal point moves by half a pixel more).
Lens scaled(const Lens& lens, double factor);

}  // namespace marey::geometry
