// Defaults of the ground job that depend on other options or on the rig, for every front end.
#pragma once

#include <optional>

#include "marey/core/rig.h"
#include "marey/pipeline/people/people_on_ground.h"

namespace marey::pipeline::people {

/// What was asked for where the default depends on other options or on the rig.
struct GroundChoices {
  bool filter = false;  ///< `tracker.filter` was chosen
  std::optional<track::ground::GroundAssociation> association = {};
};

/// Sets the defaults that depend on other options or on the rig. A filter that was chosen keeps its noise. Association: gnn if
/// `live`, which cannot wait for later decisions, otherwise mht, left for gnn if the recording has detections alone and its cameras
/// agree. A rig that was calibrated on a pitch has a pitch of the standard size unless a pitch or an area was given.
PeopleOnGroundOptions resolved(PeopleOnGroundOptions options, const Rig& rig, const GroundChoices& choices);

}  // namespace marey::pipeline::people
