#pragma once

#include <algorithm>

#include "marey/geometry/vector.h"

namespace marey::geometry {

/// An upright rectangle of pixels. A pixel's integer coordinate is its centre, the top-left pixel of an image is (0, 0), y
/// points down. `left` and `top` name the first column and row covered, so the box spans [left − ½, left − ½ + width) in
/// continuous image coordinates; all four may be fractions.
struct Box {
  double left = 0;
  double top = 0;
  double width = 0;
  double height = 0;

  bool operator==(const Box&) const = default;

  double right() const { return left + width; }   ///< one past the last column
  double bottom() const { return top + height; }  ///< one past the last row
  double area() const { return width * height; }
  bool empty() const { return !(width > 0 && height > 0); }

  /// Centre in continuous image coordinates, px.
  Vector<2> centre() const { return {left + (width - 1) / 2, top + (height - 1) / 2}; }
  /// Middle of the bottom edge: where a standing person meets the ground, px.
  Vector<2> foot() const { return {left + (width - 1) / 2, top + height - 0.5}; }

  static Box from_centre(const Vector<2>& centre, double width, double height) {
    return {centre.x() - (width - 1) / 2, centre.y() - (height - 1) / 2, width, height};
  }
};

/// Overlap of two boxes; empty (zero width or height) where they do not meet.
inline Box intersection(const Box& a, const Box& b) {
  const double left = std::max(a.left, b.left);
  const double top = std::max(a.top, b.top);
  return {left, top, std::max(0.0, std::min(a.right(), b.right()) - left), std::max(0.0, std::min(a.bottom(), b.bottom()) - top)};
}

/// Smallest box that holds both.
inline Box hull(const Box& a, const Box& b) {
  const double left = std::min(a.left, b.left);
  const double top = std::min(a.top, b.top);
  return {left, top, std::max(a.right(), b.right()) - left, std::max(a.bottom(), b.bottom()) - top};
}

/// Intersection over union, in [0, 1]; 0 where either box is empty.
inline double iou(const Box& a, const Box& b) {
  const double shared = intersection(a, b).area();
  const double all = a.area() + b.area() - shared;
  return shared > 0 && all > 0 ? shared / all : 0.0;
}

}  // namespace marey::geometry
