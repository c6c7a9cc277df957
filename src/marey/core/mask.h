#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <opencv2/core/types.hpp>

#include "marey/core/geometry.h"

namespace marey {

/// A part of a camera's image in which there is no marker (a lamp, a reflection): a rectangle, or a polygon. Px.
class Mask {
 public:
  static constexpr std::size_t kMaxCorners = 64;  ///< of a polygon
  static constexpr int kMaxDistance = 100'000;    ///< px, that an image can have on a side

  Mask(const cv::Rect& part) : box_(part) {}  // NOLINT(google-explicit-constructor): most are rectangles
  Mask(int x, int y, int width, int height) : box_(x, y, width, height) {}
  /// Three corners or more, which are pixels of it, and so are those on its edges. Where edges cross, what lies within an odd
  /// number of turns belongs to it.
  static Mask polygon(std::vector<cv::Point> corners);
  /// As `numbers` gives them; nothing if they are neither four nor the corners of a polygon, a corner is negative, a side of the
  /// rectangle is not positive, or one is larger than any image.
  static std::optional<Mask> of_numbers(std::span<const int> numbers);

  /// x, y, width, height of a rectangle; x, y of each corner of a polygon, six numbers or more.
  std::vector<int> numbers() const;
  /// The smallest rectangle that holds it.
  const cv::Rect& box() const { return box_; }
  /// Of a polygon; a rectangle reports none.
  const std::vector<cv::Point>& corners() const { return corners_; }

  /// A pixel's whole number is its centre.
  bool contains(const Vector<2>& pixel) const;
  /// In an image that is `factor` times as large: a rectangle covers all that it covered, so that nothing of it is lost; a
  /// polygon's corners go to the nearest pixel.
  Mask scaled(double factor) const;

  bool operator==(const Mask&) const = default;

 private:
  cv::Rect box_;
  std::vector<cv::Point> corners_;
};

}  // namespace marey
