// A second pass over a skeleton's whole motion: all frames at once, each pulled by its markers, neighbours by how fast joints can
// change their speed. What was hidden for a while is bent to both ends, instead of going on as it went.
//
// Minimises Σ_t markers(x_t) + Σ_t |x_{t+1} − 2 x_t + x_{t−1}|² / (a Δt²)² by Gauss–Newton from the first pass. The system has
// blocks beside its diagonal only; it is eliminated frame by frame, so that the cost is linear in the frames. Long motions are
// taken in windows that overlap.
#pragma once

#include <span>
#include <vector>

#include "marey/core/skeleton.h"
#include "marey/solve/skeleton/calibrate.h"

namespace marey::solve::skeleton {

struct SmoothOptions {
  double acceleration_rad_s2 = 100;  ///< a joint's, one standard deviation
  double acceleration_m_s2 = 15;     ///< a shift's
  double marker_sigma_m = 0.005;
  int rounds = 3;
  int window = 1500, overlap = 150;  ///< frames
};

/// `rows` are the coordinates of the first pass, one for each of `frames`, at an even rate.
std::vector<std::vector<double>> smooth(const Skeleton& skeleton, std::span<const std::vector<double>> rows,
                                        std::span<const SeenMarkers> frames, double rate_hz, const SmoothOptions& options = {});

}  // namespace marey::solve::skeleton
