// Cameras planned for a room, and a rig that is there compared with what could be expected of it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/hooks.h"
#include "marey/core/rig.h"
#include "marey/reconstruct/camera_plan.h"

namespace marey::pipeline::calibrate {

struct PlanOptions {
  std::string room;          ///< room.toml
  std::optional<int> count;  ///< in place of the room's
  std::string output;        ///< a rig file of the planned cameras; empty: none
  std::string plot;          ///< an SVG image; empty: none
  std::string rig;           ///< one that is there, to be compared; empty: none
  std::string recording;     ///< what that rig made: places with covariances; empty: none
};

/// What a recording's places were sure to, beside what its cameras could be expected to make of the same places.
struct ReachedError {
  std::int64_t points = 0;               ///< with a covariance and two cameras or more
  double reached_m = 0, expected_m = 0;  ///< medians
  double noise_px = 0;                   ///< that would explain what was reached
};

struct PlanSummary {
  Rig planned;
  reconstruct::RoomCoverage coverage;
  PlannedRoom room;
  std::optional<reconstruct::RoomCoverage> rig;  ///< of the rig that is there
  int rig_cameras = 0;
  std::optional<ReachedError> reached;
  std::vector<std::string> warnings;
};

/// Throws Error if a file cannot be read or written, or no camera sees the volume.
PlanSummary plan_room(const PlanOptions& options, const Hooks& hooks = {});

}  // namespace marey::pipeline::calibrate
