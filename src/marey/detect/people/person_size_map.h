#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <opencv2/core/types.hpp>

#include "marey/detect/people/people_size.h"

namespace marey::detect::people {

/// The size of people at each place of one camera's image, known beforehand: from a camera that is calibrated over the ground
/// they stand on. A table on a grid, because it is asked for thousands of places in each frame.
class PersonSizeMap {
 public:
  /// `size_at` gives the size of a person with feet at (x, y), px; nothing if no person can stand. It is asked for places all
  /// over the image of size `image`, and beyond: feet may lie outside.
  PersonSizeMap(cv::Size image, const std::function<std::optional<PersonSize>(double, double)>& size_at);

  /// Between the places of the grid; nothing if no person can stand.
  std::optional<PersonSize> at(double x, double y) const;

 private:
  double left_, top_;
  int columns_, rows_;
  std::vector<PersonSize> cells_;  ///< height 0 where no person can stand
};

}  // namespace marey::detect::people
