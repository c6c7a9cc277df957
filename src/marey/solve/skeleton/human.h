// A person's skeleton from standing still: joints where the segments' frames say, markers where they are seen on them. Angles are 0
// where the segments' frames are parallel (upright, arms down, feet flat), and signed as clinicians have them: flexion, adduction
// and internal rotation positive on both sides.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "marey/core/skeleton.h"

namespace marey::solve::skeleton {

/// One of a standing person's segments: x ahead, y to its left, z up; its origin is the joint by which it hangs on its parent.
struct StandingSegment {
  std::string
      name;  ///< of the human skeleton: "pelvis", "trunk", "head", "left_thigh", "left_shank", "left_foot", "left_clavicle", …
  Rigid3 world_from;
  std::optional<Vector<3>> end = {};  ///< m, in the world: where it ends, if nothing hangs on it
};

struct StandingMarker {
  std::string label;
  std::string segment;
  Vector<3> location = Vector<3>::Zero();  ///< m, in the world
};

/// The human skeleton of those segments that are there. A segment whose parent is missing is omitted, and its markers. Throws
/// Error without a pelvis. Where there is no clavicle the upper arm hangs on the trunk.
Skeleton human_skeleton(const std::string& name, std::span<const StandingSegment> segments,
                        std::span<const StandingMarker> markers);

}  // namespace marey::solve::skeleton
