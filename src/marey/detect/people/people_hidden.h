#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/geometry.h"

namespace marey::detect::people {

/// Places of one camera's image that hide people: a pole, a sign, a parked car. People pass there, yet are never seen there.
/// Learned from the boxes of people found, other parts of which were seen.
class StaticOccluders {
 public:
  /// A person's whole body lies in `person`; `mask` (CV_8UC1) is where it was seen.
  void note(const Box& person, const cv::Mat& mask);

  /// Whether pixel (x, y) hides a person behind it; false outside the image.
  bool at(double x, double y) const {
    if (x < 0 || y < 0 || x >= image_.width || y >= image_.height) return false;
    const Cell& cell = cells_[static_cast<std::size_t>(static_cast<int>(y) / side_) * columns_ + static_cast<int>(x) / side_];
    return cell.covered >= kEnough && cell.detected * kRarely < cell.covered;
  }

 private:
  static constexpr int kEnough = 10;  ///< people in front of or behind it, counted in frames
  static constexpr int kRarely = 8;   ///< one in this many may be seen, by a wrong box or noise
  struct Cell {
    std::int32_t covered = 0, detected = 0;
  };

  cv::Size image_;
  int side_ = 1;  ///< px of a cell
  int columns_ = 0;
  std::vector<Cell> cells_;
};

}  // namespace marey::detect::people
