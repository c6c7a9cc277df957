// What a recording of a person's range of motion says of its joints: segments as rigid clusters of Plug-in Gait's markers, seen
// from where they lay in the static trial; then SCoRE and SARA (solve/skeleton/functional_joints.h).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "marey/pipeline/bodies/gait_markers.h"
#include "marey/solve/skeleton/functional_joints.h"

namespace marey::pipeline::bodies {

class JointsByMotion {
 public:
  /// `conventional` is the pose of `standing` as the conventional model has it. Both must outlive it, and the motion.
  JointsByMotion(const gait::MarkerPositions& standing, gait::GaitPose conventional, const GaitMarkers& motion);

  /// In the static trial's world, m. A thigh that shows two markers gets a third from the shank: the other end of the knee's axis,
  /// which both share.
  std::optional<solve::skeleton::FunctionalCentre> hip(gait::Side side) const;
  /// Likewise; `hip` is the centre that the thigh hangs on.
  std::optional<solve::skeleton::FunctionalAxis> knee(gait::Side side, const Vector<3>& hip) const;
  /// Nothing if the upper arm shows no more than its elbow's marker.
  std::optional<solve::skeleton::FunctionalAxis> elbow(gait::Side side) const;

 private:
  using Poses = std::vector<std::optional<Rigid3>>;  // static trial to each row
  struct Carried {
    Vector<3> location;  // in the static trial
    const Poses* by;     // what it is fixed to
  };
  std::vector<std::string> labels_of(gait::SegmentId segment) const;
  Poses poses_of(const std::vector<std::string>& labels, const std::vector<Carried>& carried = {}) const;
  Poses shank_poses(gait::Side side) const;
  bool predominantly_observed(const std::string& label) const;

  const gait::MarkerPositions& standing_;
  gait::GaitPose conventional_;
  const GaitMarkers& motion_;
  Poses pelvis_;
};

}  // namespace marey::pipeline::bodies
