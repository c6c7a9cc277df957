#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/geometry.h"

namespace marey::simulate::people {

/// A shape on a lattice finer than the pixels: `samples` × `samples` points in each. Column i of the lattice lies at
/// x = (i + ½) / samples − ½ px, so that pixel p holds columns p · samples … (p + 1) · samples − 1.
struct Silhouette {
  int samples = 4;
  cv::Rect lattice;  ///< the part of the lattice that `mask` covers: whole pixels, but they may lie outside the image
  cv::Mat mask;      ///< CV_8UC1 of lattice.size(): not zero where the shape is

  bool empty() const { return mask.empty(); }
  /// Pixels that `lattice` covers.
  cv::Rect pixels() const;
  double area() const;       ///< px²
  Box box() const;           ///< tight, px, to a lattice step; empty if there is nothing
  Vector<2> centre() const;  ///< of the area, px. Pre: not empty
  /// CV_8UC1 of the image's size: 255 where at least half of a pixel is covered.
  cv::Mat pixel_mask(cv::Size image) const;
};

/// Takes from `silhouette` what `front` covers. Both have the same samples.
void take_away(Silhouette& silhouette, const Silhouette& front);

/// Takes from `silhouette` what lies outside an image.
void crop(Silhouette& silhouette, cv::Size image);

/// The convex hull of two discs, px.
struct RoundCone2 {
  Vector<2> from, to;
  double from_radius = 0, to_radius = 0;
};

/// A lattice of `box` (px, may reach outside the image), nothing in it yet.
Silhouette blank_silhouette(const Box& box, int samples);

/// The box of a shape, px, in the sense of Box.
Box bounds(const RoundCone2& shape);
Box bounds(std::span<const Vector<2>> polygon);

/// Marks the lattice points in a shape. The value is `value` + a shade 0 … `shades` − 1 that grows with the distance from the
/// left edge of the shape's row to its right edge; shades = 1 writes `value` itself. `value` is not zero.
void fill(Silhouette& silhouette, const RoundCone2& shape, std::uint8_t value, int shades = 1);
void fill_convex(Silhouette& silhouette, std::span<const Vector<2>> polygon, std::uint8_t value, int shades = 1);

}  // namespace marey::simulate::people
