// The floor, the vertical and the metre, by people who walk.
#pragma once

#include <optional>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/core/keypoints.h"
#include "marey/geometry/rigid.h"

namespace marey::calibrate::people {

/// A body in space at one instant, in any unit.
struct Body3 {
  int person = 0;
  double time_s = 0;
  std::vector<std::optional<Vector<3>>> points;  ///< by the set
};

struct PeopleWorld {
  Rigid3 moved_from_world;  ///< z up, z = 0 the floor, the origin below the middle of the bodies; in the unit of the bodies
  double height = 0;        ///< of the person most seen, in the unit of the bodies; 0: not known
};

/// Upright is how bodies stand on the mean, and the plane of the lower foot of each, each as far as it is sure; a person's height
/// comes from eyes above ankles (Drillis & Contini, "Body segment parameters", 1966: 0.936 and 0.039 of the stature). Nothing if no
/// body has ankles and shoulders. `bodies` of a person in the order of time.
std::optional<PeopleWorld> world_of(const std::vector<Body3>& bodies, const KeypointSet& set);

}  // namespace marey::calibrate::people
