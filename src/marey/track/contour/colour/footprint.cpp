#include "marey/track/contour/colour/footprint.h"

#include <algorithm>
#include <cmath>

namespace marey::track::contour::colour {

void Footprint::fill(std::span<const Vector<2>> polygon) {
  width_ = height_ = 0;
  if (polygon.size() < 3) return;
  Vector<2> minimum = polygon[0], maximum = polygon[0];
  for (const Vector<2>& corner : polygon) {
    minimum = minimum.cwiseMin(corner);
    maximum = maximum.cwiseMax(corner);
  }
  constexpr double kFar = 1e5;  // px; numerical: beyond any image, and rows fit into int
  if (!(minimum.minCoeff() > -kFar && maximum.maxCoeff() < kFar)) return;
  left_ = static_cast<int>(std::ceil(minimum.x()));
  top_ = static_cast<int>(std::ceil(minimum.y()));
  width_ = std::max(0, static_cast<int>(std::floor(maximum.x())) + 1 - left_);
  height_ = std::max(0, static_cast<int>(std::floor(maximum.y())) + 1 - top_);
  pixels_.assign(static_cast<std::size_t>(width_) * height_, 0);
  if (pixels_.empty()) return;
  // Every edge flips the first pixel at its right, row by row; what is flipped an odd number of times up to a pixel is inside.
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector<2>& a = polygon[i];
    const Vector<2>& b = polygon[i + 1 < polygon.size() ? i + 1 : 0];
    const int begin = static_cast<int>(std::ceil(std::min(a.y(), b.y()))),
              end = static_cast<int>(std::ceil(std::max(a.y(), b.y())));
    const double slope = (b.x() - a.x()) / (b.y() - a.y());  // not used where it is not finite: no row is crossed
    for (int y = begin; y < end; ++y) {
      const int x = std::max(left_, static_cast<int>(std::ceil(a.x() + (y - a.y()) * slope)));
      if (x < left_ + width_) pixels_[static_cast<std::size_t>(y - top_) * width_ + (x - left_)] ^= 1;
    }
  }
  for (int y = 0; y < height_; ++y) {
    std::uint8_t* row = pixels_.data() + static_cast<std::size_t>(y) * width_;
    for (int x = 1; x < width_; ++x) row[x] ^= row[x - 1];
  }
}

}  // namespace marey::track::contour::colour
