// A camera that pans, tilts and zooms on a tripod: what of it stays, and what three numbers change.
//
// The pan axis is fixed to the tripod, which may lean; the tilt axis is carried round by it. The centre of projection lies a little
// ahead of the place where the axes meet (the nodal offset), so that nearer things move against farther ones as it turns. The
// lens has one radial term, counted in the image and not in focal lengths, so that it stays about the same while the lens zooms.
// Reference: Thomas, "Real-time camera tracking using sports pitch markings", J. Real-Time Image Processing 2007 (place solved
// once); Magera et al., "BroadTrack", WACV 2025 (nodal offset and one radial term on real broadcasts).
#pragma once

#include <array>
#include <cmath>

#include "marey/geometry/camera.h"

namespace marey::geometry {

/// What stays. As numbers for a solver: place 3, lean 2, roll, ahead, bend.
struct Tripod {
  static constexpr int numbers = 8;

  Vector<3> location = Vector<3>::Zero();  ///< m, in the world: where the axes meet
  Vector<2> lean = Vector<2>::Zero();      ///< rad, about the world's x and y: how far the pan axis is from upright
  double roll = 0;                         ///< rad, about the optical axis
  double ahead = 0;                        ///< m: from the axes to the centre of projection, along the optical axis
  double bend = 0;                         ///< radial term per half image width squared: seen = straight · (1 + bend · |straight|²)

  std::array<double, numbers> as_numbers() const {
    return {location.x(), location.y(), location.z(), lean.x(), lean.y(), roll, ahead, bend};
  }
  static Tripod of(const std::array<double, numbers>& n) { return {{n[0], n[1], n[2]}, {n[3], n[4]}, n[5], n[6], n[7]}; }
};

/// What turns. pan 0 faces along the world's y and grows to the right, tilt 0 is level and grows downwards, rad; the focal length
/// is counted in half image widths.
struct Heading {
  double pan = 0, tilt = 0, log_focal = 0;

  Vector<3> as_vector() const { return {pan, tilt, log_focal}; }
  static Heading of(const Vector<3>& v) { return {v.x(), v.y(), v.z()}; }
};

/// Axes and centre of a camera on a tripod, on any scalar, so that a solver can differentiate it.
template <typename T>
struct TripodFrame {
  using V2 = Eigen::Matrix<T, 2, 1>;
  using V3 = Eigen::Matrix<T, 3, 1>;

  /// `tripod` as Tripod::as_numbers, `heading` pan, tilt and ln of the focal length.
  TripodFrame(const T* tripod, const T* heading) {
    using std::cos;
    using std::exp;
    using std::sin;
    const T cp = cos(heading[0]), sp = sin(heading[0]), ct = cos(heading[1]), st = sin(heading[1]);
    const V3 level_right(cp, -sp, T(0)), inspect(sp * ct, cp * ct, -st);
    const V3 level_down = inspect.cross(level_right);
    const T cr = cos(tripod[5]), sr = sin(tripod[5]);
    const T cx = cos(tripod[3]), sx = sin(tripod[3]), cy = cos(tripod[4]), sy = sin(tripod[4]);
    const auto lean = [&](const V3& v) {  // Ry(lean.y) · Rx(lean.x) · v
      const V3 w(v.x(), cx * v.y() - sx * v.z(), sx * v.y() + cx * v.z());
      return V3(cy * w.x() + sy * w.z(), w.y(), -sy * w.x() + cy * w.z());
    };
    right = lean(cr * level_right + sr * level_down);
    down = lean(cr * level_down - sr * level_right);
    ahead = lean(inspect);
    centre = V3(tripod[0], tripod[1], tripod[2]) + tripod[6] * ahead;
    focal = exp(heading[2]);
    bend = tripod[7];
  }

  /// m before the camera.
  T depth(const V3& location) const { return ahead.dot(location - centre); }

  /// Where a place (m) is seen, half image widths from the middle; what is nearer than `least` m is held there.
  V2 detected(const V3& location, double minimum = 0.5) const {
    const V3 off = location - centre;
    T z = ahead.dot(off);
    if (!(z > T(minimum))) z = T(minimum);
    const V2 straight(focal * right.dot(off) / z, focal * down.dot(off) / z);
    return straight * (T(1) + bend * straight.squaredNorm());
  }

  V3 right, down, ahead, centre;
  T focal, bend;
};

/// The camera that the tripod carries when it is turned so; lens model brown, principal point in the middle of the image.
Camera camera_of(const Tripod& tripod, const Heading& heading, cv::Size size);

/// From half image widths about the middle to px, and back.
inline Vector<2> to_pixel(const Vector<2>& at, cv::Size size) {
  return {(size.width - 1) / 2.0 + at.x() * size.width / 2.0, (size.height - 1) / 2.0 + at.y() * size.width / 2.0};
}
inline Vector<2> from_pixel(const Vector<2>& pixel, cv::Size size) {
  return {(pixel.x() - (size.width - 1) / 2.0) / (size.width / 2.0), (pixel.y() - (size.height - 1) / 2.0) / (size.width / 2.0)};
}

}  // namespace marey::geometry
