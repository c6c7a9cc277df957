#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "marey/core/geometry.h"

namespace marey::track::contour::colour {

/// The pixels that a target covers, as it is predicted.
class Footprint {
 public:
  /// Of a closed polygon: the pixels whose centre lies inside (even-odd). Memory is kept from call to call.
  void fill(std::span<const Vector<2>> polygon);

  bool covers(int x, int y) const {
    x -= left_;
    y -= top_;
    return x >= 0 && y >= 0 && x < width_ && y < height_ && pixels_[static_cast<std::size_t>(y) * width_ + x] != 0;
  }
  int left() const { return left_; }
  int top() const { return top_; }
  int width() const { return width_; }
  int height() const { return height_; }
  std::span<const std::uint8_t> row(int y) const {
    return {pixels_.data() + static_cast<std::size_t>(y - top_) * width_, static_cast<std::size_t>(width_)};
  }

 private:
  int left_ = 0, top_ = 0, width_ = 0, height_ = 0;
  std::vector<std::uint8_t> pixels_;
};

}  // namespace marey::track::contour::colour
