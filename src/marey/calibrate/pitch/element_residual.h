// How far a labelled point lies from the element of the pitch that a camera projects, differentiable in the camera.
//
// The labelled pixel is straightened once by the radial term, so that in the plane it comes to a straight element is a straight
// line and an arc a conic: across them the distance is to the line, or to the conic by Sampson's first-order formula. Where the
// point lies past an element's end, the distance is to that end.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <variant>

#include <opencv2/core/types.hpp>

#include "marey/core/geometry.h"
#include "marey/geometry/camera.h"
#include "marey/geometry/pitch_elements.h"

namespace marey::calibrate::pitch {

/// A main camera in nine numbers: pan and tilt (0, 0 faces along y, the tilt grows downwards, the pan to the right), roll, all rad;
/// ln of the focal length in half image widths; the place, m; the radial term, per half image width squared.
struct ElementView {
  enum { pan, tilt, roll, log_focal, x, y, z, bend, numbers };
  std::array<double, numbers> p{};
};

/// The camera of these numbers, with an image of that size; lens model brown, principal point in the middle.
geometry::Camera camera_of(const ElementView& view, cv::Size size);

/// Axes and place of a view.
template <typename T>
struct ElementFrame {
  using V3 = Eigen::Matrix<T, 3, 1>;
  using V2 = Eigen::Matrix<T, 2, 1>;

  explicit ElementFrame(const T* p) {
    using std::cos;
    using std::exp;
    using std::sin;
    const T cp = cos(p[ElementView::pan]), sp = sin(p[ElementView::pan]);
    const T ct = cos(p[ElementView::tilt]), st = sin(p[ElementView::tilt]);
    const T cr = cos(p[ElementView::roll]), sr = sin(p[ElementView::roll]);
    ahead = V3(sp * ct, cp * ct, -st);
    const V3 level_right(cp, -sp, T(0)), level_down = ahead.cross(level_right);
    right = cr * level_right + sr * level_down;
    down = cr * level_down - sr * level_right;
    centre = V3(p[ElementView::x], p[ElementView::y], p[ElementView::z]);
    focal = exp(p[ElementView::log_focal]);
  }

  /// A place (m) to homogeneous coordinates of the straightened image, half widths from its middle; the third is the depth.
  V3 detected(const V3& location) const {
    const V3 off = location - centre;
    return {focal * right.dot(off), focal * down.dot(off), ahead.dot(off)};
  }

  V3 ahead, right, down, centre;
  T focal;
};

/// `distorted`, half widths from the middle, straightened: distorted = straight · (1 + bend · |straight|²).
template <typename T>
Eigen::Matrix<T, 2, 1> straightened(const Vector<2>& distorted, const T& bend) {
  const double d2 = distorted.squaredNorm();
  T grow = T(1);  // straight = grow · distorted
  for (int i = 0; i < 4; ++i) {
    const T square = bend * d2 * grow * grow;
    grow -= (grow * (T(1) + square) - T(1)) / (T(1) + T(3) * square);
  }
  return {grow * distorted.x(), grow * distorted.y()};
}

namespace element_residual {

constexpr double kMinDepth = 0.5;  // m

/// From `at` to where `place` is seen; what lies behind the camera is held before it.
template <typename T>
Eigen::Matrix<T, 2, 1> to_position(const ElementFrame<T>& frame, const Eigen::Matrix<T, 3, 1>& location,
                                   const Eigen::Matrix<T, 2, 1>& at) {
  Eigen::Matrix<T, 3, 1> detected = frame.detected(location);
  if (!(detected.z() > T(kMinDepth))) detected.z() = T(kMinDepth);
  return Eigen::Matrix<T, 2, 1>(detected.x() / detected.z(), detected.y() / detected.z()) - at;
}

template <typename T>
Eigen::Matrix<T, 2, 1> off(const geometry::StraightElement& line, const ElementFrame<T>& frame, const Eigen::Matrix<T, 2, 1>& at) {
  using std::sqrt;
  using V3 = Eigen::Matrix<T, 3, 1>;
  const V3 from = line.from.cast<T>(), along = (line.to - line.from).cast<T>();
  const V3 a = frame.detected(from), b = frame.detected(V3(from + along));
  const V3 n = a.cross(b);
  const T length = sqrt(n.x() * n.x() + n.y() * n.y() + T(1e-30));
  const Eigen::Matrix<T, 2, 1> direction(-n.y() / length, n.x() / length);
  // The place on the line that is seen beside the point: (a + t d), d = b − a.
  const V3 d = b - a;
  const T over = direction.x() * (a.x() - at.x() * a.z()) + direction.y() * (a.y() - at.y() * a.z());
  const T under = direction.x() * (d.x() - at.x() * d.z()) + direction.y() * (d.y() - at.y() * d.z());
  const T t = -over / under;
  if (!(t > T(0))) return to_position(frame, from, at);
  if (t > T(1)) return to_position(frame, V3(from + along), at);
  if (!(a.z() + t * d.z() > T(kMinDepth))) return to_position(frame, V3(from + t * along), at);
  return {(n.x() * at.x() + n.y() * at.y() + n.z()) / length, T(0)};
}

template <typename T>
Eigen::Matrix<T, 2, 1> off(const geometry::ArcElement& arc, const ElementFrame<T>& frame, const Eigen::Matrix<T, 2, 1>& at) {
  using std::atan2;
  using std::sqrt;
  using V3 = Eigen::Matrix<T, 3, 1>;
  const V3 centre(T(arc.centre.x()), T(arc.centre.y()), T(0));
  // Columns of the map from the ground, about the arc's centre, to the image; its inverse but for a factor.
  const V3 a(frame.focal * frame.right.x(), frame.focal * frame.down.x(), frame.ahead.x());
  const V3 b(frame.focal * frame.right.y(), frame.focal * frame.down.y(), frame.ahead.y());
  const V3 c = frame.detected(centre);
  const V3 r0 = b.cross(c), r1 = c.cross(a), r2 = a.cross(b);
  const V3 point(at.x(), at.y(), T(1));
  const T gx = r0.dot(point), gy = r1.dot(point), gw = r2.dot(point);
  const double square = arc.radius * arc.radius;
  const double middle = (arc.from + arc.to) / 2, half = (arc.to - arc.from) / 2;
  const bool ahead = gw * r2.dot(c) > T(0);  // else the pixel is above the horizon
  T from_middle = gw > T(0) ? atan2(gy, gx) : atan2(-gy, -gx);
  from_middle -= T(middle);
  if (from_middle > T(std::numbers::pi)) from_middle -= T(2 * std::numbers::pi);
  if (from_middle < T(-std::numbers::pi)) from_middle += T(2 * std::numbers::pi);
  if (!ahead || from_middle > T(half) || from_middle < T(-half)) {
    const double end = !ahead ? middle : from_middle > T(0) ? arc.to : arc.from;
    const V3 location(T(arc.centre.x() + arc.radius * std::cos(end)), T(arc.centre.y() + arc.radius * std::sin(end)), T(0));
    return to_position(frame, location, at);
  }
  const T value = gx * gx + gy * gy - T(square) * gw * gw;
  const V3 by_point = T(2) * (gx * r0 + gy * r1 - T(square) * gw * r2);
  return {value / sqrt(by_point.x() * by_point.x() + by_point.y() * by_point.y() + T(1e-30)), T(0)};
}

}  // namespace element_residual

/// From the straightened point `at` to the element, in half image widths: across it alone, or to the end that it lies past.
template <typename T>
Eigen::Matrix<T, 2, 1> off(const geometry::PitchElement& element, const ElementFrame<T>& frame, const Eigen::Matrix<T, 2, 1>& at) {
  return std::visit([&](const auto& shape) { return element_residual::off(shape, frame, at); }, element.shape);
}

}  // namespace marey::calibrate::pitch
