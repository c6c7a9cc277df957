#pragma once

#include <optional>
#include <span>
#include <vector>

#include "marey/assign/gated_assignment.h"
#include "marey/core/track.h"
#include "marey/reconstruct/ray_groups.h"

namespace marey::reconstruct {

/// Gives each prediction of a tracker the blobs that it explains: step (1) of correspond.h.
class TrackMatches {
 public:
  TrackMatches(double sigmas, const Triangulator& triangulator) : sigmas_(sigmas), triangulator_(triangulator) {}

  /// Adds a group for every prediction that has a point; `missed[i]` says why prediction i has none.
  void match(const FrameRays& frame, std::span<const Track<3>> expected, RayGroups& groups,
             std::vector<std::optional<NoPoint>>& missed);

 private:
  /// Room for one camera's assignment.
  struct InCamera {
    std::vector<int> contenders;  // by ray
    std::vector<assign::GatedPair> pairs;
    assign::GatedAssigner assigner;
  };

  /// The rays that one prediction was given, and where they meet.
  struct Intersected {
    RayList list;
    Triangulation point;
  };

  void match_in(const FrameRays& frame, int camera, std::span<const Track<3>> expected, InCamera& work);
  void intersect(const FrameRays& frame, std::size_t index, const Track<3>& expected, Intersected& result) const;
  std::optional<NoPoint> location(const FrameRays& frame, int index, const Track<3>& expected, RayGroups& groups);
  bool complete(const FrameRays& frame, const RayList& list, const SpacePoint& point, const RayGroups& groups);

  double sigmas_;
  const Triangulator& triangulator_;
  std::vector<int> matched_;  // by prediction and camera: the ray, or −1
  std::vector<InCamera> in_camera_;
  std::vector<Intersected> first_;  // by prediction
  RayList list_, better_;
};

}  // namespace marey::reconstruct
