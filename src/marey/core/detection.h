#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "marey/core/geometry.h"

namespace marey {

/// One thing seen in one frame.
struct Detection {
  Vector<2> centre = Vector<2>::Zero();  ///< px; of the area seen, not of the box
  std::optional<Matrix<2>> covariance;   ///< of `centre`, px²; nothing if the source does not specify it
  double area = 0;                       ///< px²
  Box box;                               ///< px
  std::vector<Vector<2>> outline;        ///< closed polygon along pixel edges, ordered; empty if absent
  double score = 1;                      ///< how sure the detector is, in [0, 1]
  std::optional<int> group;              ///< several people share this region: its number within the frame

  /// The standard deviation of a coordinate of `centre`, px: the root mean square of both.
  std::optional<double> sigma() const {
    if (!covariance) return std::nullopt;
    return std::sqrt(covariance->trace() / 2);
  }
};

/// Where a tracker expects a thing it follows to be seen in the frame to come.
struct Expected {
  Box box;  ///< px
};

}  // namespace marey
