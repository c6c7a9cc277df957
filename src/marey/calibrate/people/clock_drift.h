// By how much cameras' clocks run fast or slow, from what an adjustment leaves: a point that moves with velocity v (px/s) and is
// exposed τ later than was taken lies v τ beside where the others say. τ = a + b t of all cameras is fitted at once by least
// squares over the inliers, b under a prior, the points' places eliminated (Schur's complement), poses and lenses held: one camera
// after the other, each against points that its own view has placed too, three of four cameras would go after the fourth by a
// quarter a round. Cost: linear in the observations.
#pragma once

#include <vector>

#include "marey/calibrate/bundle/bundle.h"

namespace marey::calibrate::people {

/// A camera's times t (s, by the rig's clock) are to become t + offset_s + drift · t.
struct ClockCorrection {
  double offset_s = 0;
  double drift = 0;
  double deviation = 0;  ///< of the drift, by the noise of single points
};

/// Of each camera; nothing of those whose offset is held. `times_s`: of each body of the bundle (free points, the observations of
/// one behind each other), by the rig's clock; `drifts`: what was taken for each camera until now, relative.
std::vector<ClockCorrection> clock_corrections(const bundle::Bundle& bundle, const bundle::BundleResult& fitted,
                                               const std::vector<double>& times_s, const std::vector<double>& drifts);

}  // namespace marey::calibrate::people
