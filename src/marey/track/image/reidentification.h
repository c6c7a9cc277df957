#pragma once

#include <span>
#include <vector>

#include "marey/assign/gated_assignment.h"
#include "marey/core/observation.h"
#include "marey/core/time.h"
#include "marey/track/image/target.h"

namespace marey::track::image {

/// Re-identification before a static camera still, where no target vanishes but behind something: an observation of its size
/// that appears where it may have gone by now, and that matches no other target, is it. So is one that was seen just before, and
/// turned so sharply that it left its gate.
class Reidentification {
 public:
  /// What decides whether an observation may be a target that was lost.
  struct Limits {
    double min_score = 0;  ///< of an observation
    BoxSizeOptions sizes;
    double gate = 0;  ///< squared deviations by which sizes may differ, at most
  };

  /// Matches such observations with confirmed targets that have none and are not hidden by another.
  void match(std::span<Target> targets, std::span<const Observation<2>> detected, Timestamp now, const Limits& limits);

 private:
  std::vector<char> taken_;
  std::vector<assign::GatedPair> pairs_;
  assign::GatedAssigner assigner_;
};

/// Where a box puts the centre of a target: if need be corrected for a size that is not trusted.
Vector<2> position_in(const Box& box, const Target& target, const BoxSizeOptions& sizes);

}  // namespace marey::track::image
