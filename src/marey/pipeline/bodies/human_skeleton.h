// A person's skeleton from standing still and, where there is a recording of its range of motion, from how its joints move.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "marey/analyse/gait/body_marker_sets.h"
#include "marey/core/hooks.h"
#include "marey/core/skeleton.h"
#include "marey/format/format.h"

namespace marey::pipeline::bodies {

/// Where a joint is, and why.
struct FoundJoint {
  std::string name;        ///< "left hip", "right knee", …
  bool by_motion = false;  ///< the motion has a say; else the conventional model's place stays
  double deviation = 0;    ///< one standard deviation: of a hip's centre m, of a knee's or elbow's axis rad; where it is by motion
  double moved = 0;        ///< from where the conventional model has it, likewise
  std::string stated;      ///< one sentence
};

struct HumanOptions {
  std::string motion =
      {};  ///< a recording of the same person with the same markers, in which hips, knees and elbows move; empty: none
  std::string marker_set = {};  ///< analyse/gait/body_marker_sets.h; empty: known by the labels
  std::optional<format::UpAxis> up = {};
};

struct HumanSkeleton {
  Skeleton skeleton;
  std::string marker_set;          ///< its title
  std::vector<FoundJoint> joints;  ///< that the motion was asked for
  std::vector<std::string> warnings;
  const analyse::gait::BodyMarkerSet* set = nullptr;
  analyse::gait::MarkerPositions standing;  ///< m, by the model's labels
};

/// The human skeleton of a person who stands still with a marker set of the field, calibrated to it. Throws Error if the labels
/// are not set, the pelvis is not known, or who should stand still moves.
HumanSkeleton human_from_static(const std::string& standing, const HumanOptions& options, const Hooks& hooks);

/// The same without a static trial: of a moving person, from the stillest instant of `motion` (gait_markers.h). Its first warning
/// says so. What the moment's posture leaves open is for solve/skeleton/calibrate.h to find from the motion. Throws Error if the
/// labels are not set, or the pelvis is not known.
HumanSkeleton human_from_motion(const std::string& motion, const HumanOptions& options, const Hooks& hooks);

}  // namespace marey::pipeline::bodies
