#pragma once

#include <span>
#include <vector>

#include "marey/reconstruct/keypoints/people_in_views.h"

namespace marey::pipeline::keypoints {

/// How many times the deviations that a network states its points' errors are, by how well several cameras' half-lines meet.
/// Learned from the first seconds of a live run, block by block; recordings are searched for it as a whole (keypoints_in_space.h).
class LiveNoise {
 public:
  double times_stated() const { return noise_; }
  bool is_learned() const { return blocks_ > 0; }

  /// The people of one instant, placed with `slack` times the present noise.
  void learn(std::span<const reconstruct::keypoints::LocatedPerson> people, double slack);

 private:
  double noise_ = 2.6;           // of a network in a rig that is not known yet
  std::vector<double> squares_;  // of the block's points, a degree of freedom
  int blocks_ = 0;
};

}  // namespace marey::pipeline::keypoints
