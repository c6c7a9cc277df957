// Who in one camera's images is who in another's, and by how much the one was started after the other, where neither camera is
// calibrated.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "marey/calibrate/people/image_people.h"
#include "marey/geometry/camera.h"

namespace marey::calibrate::people {

/// A camera's people and its clock: frame k at k / rate_hz + offset_s.
struct CameraPeople {
  std::vector<ImagePerson> people;
  double rate_hz = 0, offset_s = 0;
  bool offset_known = false;
  Camera lens;                              ///< the lens alone, as good as it is known
  std::optional<double> stated_focal = {};  ///< what the camera's file states, of the longer side; only where the rig has no lens
};

struct PeopleMatch {
  std::vector<double> offsets_s;               ///< by camera, in place of its own
  std::vector<std::vector<int>> identity;      ///< by camera and its people; -1: in no other camera
  int people = 0;                              ///< identities
  std::vector<std::vector<double>> agreement;  ///< by camera and camera: share of the points that one geometry explains; 0: none
};

/// Offsets are searched up to `max_offset_s` from those that the cameras have; 0: not at all. `seed` of RANSAC. Cameras that no
/// person chains to the first keep the offset they have.
PeopleMatch match_people(const std::vector<CameraPeople>& cameras, double max_offset_s, std::uint64_t seed);

}  // namespace marey::calibrate::people
