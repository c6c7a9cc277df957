#pragma once

#include <vector>

#include "marey/reconstruct/epipolar.h"
#include "marey/reconstruct/ray_groups.h"

namespace marey::reconstruct {

/// Finds the points at which rays of several cameras meet: steps (2) and (3) of correspond.h.
class RayIntersections {
 public:
  /// Keeps references to neither camera nor frame.
  RayIntersections(std::span<const Camera> cameras, double sigmas, const Triangulator& triangulator);

  /// Adds groups of three rays and more among those that are free.
  void find(const FrameRays& frame, RayGroups& groups);

  /// After `find`: adds pairs of free rays each of which is the other's only partner.
  void find_pairs(const FrameRays& frame, RayGroups& groups);

 private:
  struct Proposal {
    SpacePoint point;
    int begin = 0, count = 0;  // in `members_`
    double misfit() const { return point.chi_square / (2 * point.rays - 3); }
  };

  void propose(const FrameRays& frame, const EpipolarPair& pair, const EpipolarMatcher& cameras, const RayGroups& groups);
  void extend(const FrameRays& frame, const EpipolarPair& pair, const EpipolarMatcher& cameras, const RayGroups& groups);
  void settle(std::vector<Proposal>& proposals, RayGroups& groups);

  double sigmas_;
  const Triangulator& triangulator_;
  std::vector<EpipolarMatcher> matchers_;
  std::vector<EpipolarPair> pairs_;
  std::vector<EpipolarPair> lonely_;  // pairs that no third camera confirms
  std::vector<Proposal> large_, small_;
  std::vector<int> members_;
  std::vector<int> small_of_ray_;  // the last group of three that a ray was proposed in
  std::vector<int> partners_;
  RayList list_;
};

}  // namespace marey::reconstruct
