// A second pass over a skeleton's whole motion, all frames at once: what was hidden for a while is bent to both ends, instead of
// continuing as it went; what markers show stays where they have it.
//
// Where markers are hidden, those left say something else than all did together, for none fits exactly (skin, the model): the pose
// would step when they go and when they return. So each marker near a hidden one is taken to sit where it was found at both ends,
// on the mean in between, and angles that no marker shows start on the line from one end to the other.
//
// Minimises Σ_t markers(x_t) + Σ_t d_tᵀ W_t d_t, d_t = x_{t+1} − 2 x_t + x_{t−1}, by Gauss–Newton. W is (a Δt²)⁻² in the directions
// that no marker shows and falls with what the markers say, as the prediction of the PoseSolver does: both terms grow alike with
// the frame rate, and no speed biases what is observed. The system has blocks beside its diagonal only; it is eliminated frame by
// frame, so that the cost is linear in the frames. Long motions are taken in windows that overlap.
#pragma once

#include <span>
#include <vector>

#include "marey/core/skeleton.h"
#include "marey/solve/skeleton/calibrate.h"

namespace marey::solve::skeleton {

struct SmoothOptions {
  double acceleration_rad_s2 = 50;  ///< a joint's, one standard deviation
  double acceleration_m_s2 = 7.5;   ///< a shift's
  double hidden_s = 2;              ///< a marker that is away for longer is gone: it is not a gap
  int rounds = 4;
  int window = 800, overlap = 150;  ///< frames
};

/// `rows` are the coordinates of the first pass, one for each of `frames`, at an even rate.
std::vector<std::vector<double>> smooth(const Skeleton& skeleton, std::span<const std::vector<double>> rows,
                                        std::span<const ObservedMarkers> frames, double rate_hz, const SmoothOptions& options = {});

}  // namespace marey::solve::skeleton
