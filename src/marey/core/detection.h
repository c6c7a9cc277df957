#pragma once

#include <optional>
#include <vector>

#include "marey/core/geometry.h"

namespace marey {

/// One thing seen in one frame.
struct Detection {
  Vector<2> centre = Vector<2>::Zero();          ///< px; of the area seen, not of the box
  Matrix<2> covariance = Matrix<2>::Identity();  ///< of `centre`, px²
  double area = 0;                               ///< px²
  Box box;                                       ///< px
  std::vector<Vector<2>> outline;                ///< closed polygon along pixel edges, ordered; empty where there is none
  double score = 1;                              ///< how sure the detector is, in [0, 1]
  std::optional<int> group;                      ///< several people share this region: its number within the frame
};

/// Where a tracker expects a thing it follows to be seen in the frame to come.
struct Expected {
  Box box;  ///< px
};

}  // namespace marey
