#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "marey/core/geometry.h"

namespace marey {

/// Which body points there are, and what connects them.
struct KeypointSet {
  std::string name;                        ///< "blazepose", "coco", …
  std::vector<std::string> points;         ///< "left_knee", …: each name once
  std::vector<std::pair<int, int>> bones;  ///< between points, to be drawn
  std::vector<int> mirrored;               ///< of each point its counterpart on the other side; itself if it has none

  bool operator==(const KeypointSet&) const = default;
};

/// One body point: px in an image, m in space.
template <int D>
struct Keypoint {
  Vector<D> position = Vector<D>::Zero();
  Matrix<D> covariance = Matrix<D>::Identity();
  double visibility = 1;  ///< probability that nothing hides it, in [0, 1]
  double presence = 1;    ///< probability that it is within the image, in [0, 1]
};

/// The body points of one person in one image or in space, in the order of a KeypointSet; those that are not supported: absent.
template <int D>
struct Keypoints {
  std::vector<std::optional<Keypoint<D>>> points;
  double presence = 1;  ///< probability that there is a person at all, in [0, 1]
};

}  // namespace marey
