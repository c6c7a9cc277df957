#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/core/keypoint_sequence.h"

namespace marey::calibrate::people {

/// The points of a person that are surely seen, px; none at all where they are too few. What they state as their deviations, px,
/// is added to `sigmas`.
std::vector<std::optional<Vector<2>>> sure_points(const Keypoints<2>& person, std::vector<double>* sigmas = nullptr);

/// Mean distance of the points that both have, in sizes of the body `a`; infinite where they have none in common.
double distance_in_sizes(const std::vector<std::optional<Vector<2>>>& a, const std::vector<std::optional<Vector<2>>>& b);

/// One person through one camera's frames.
struct ImagePerson {
  std::size_t first = 0;  ///< frame
  std::vector<std::vector<std::optional<Vector<2>>>>
      frames;           ///< from `first` on: the points that are surely seen, px; or none of them
  double sigma_px = 1;  ///< median deviation that its points state

  std::size_t end() const { return first + frames.size(); }
  /// Between two frames on the straight line; nothing if one of them does not show the point.
  std::optional<Vector<2>> at(double frame, std::size_t point) const;
};

/// Links the people of successive frames, the nearest first, by how far their points moved in units of the body; a person who is
/// not there for a quarter of a second is another one. Those seen for less than half a second are omitted. The longest first.
std::vector<ImagePerson> image_people(const KeypointSequence& sequence, double rate_hz);

/// As they would be in the mirrored image, of `width` px: left and right are exchanged, of the places and of the points' names.
std::vector<ImagePerson> mirrored(std::vector<ImagePerson> people, const KeypointSet& set, int width);

}  // namespace marey::calibrate::people
