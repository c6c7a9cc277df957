#pragma once

// How noisy are the measurements, and how much does the velocity stray? Both are read off the clip itself: of all pairs of
// measurement noise and process noise, the pair under which a constant-velocity Kalman filter finds the measured positions
// likeliest (maximum likelihood by the prediction-error decomposition; Schweppe, "Evaluation of likelihood functions for
// Gaussian signals", IEEE Trans. IT 11, 1965). Only the ratio of the two has to be searched: for a given ratio the best size
// of both follows from the mean squared innovation in closed form.
//
// Assumes noise alike in all axes and targets. Cost: about 60 passes of a scalar filter over the positions.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "marey/filter/filters.h"

namespace marey::filter {

/// One target's measured positions in the order of time.
template <int D>
struct MeasuredPath {
  std::vector<double> times;         ///< s, increasing
  std::vector<Vector<D>> positions;  ///< px or m, one for each time
};

struct NoiseFit {
  double measurement_sigma = 0;   ///< standard deviation of a measured coordinate, px or m
  double acceleration_noise = 0;  ///< white acceleration, square root of its density: px/s^1.5 or m/s^1.5
  double acceleration = 0;        ///< root mean square acceleration over a typical step: acceleration_noise / √step, px/s² or m/s²
  double speed = 0;               ///< root mean square speed per axis, px/s or m/s
  double log_likelihood = 0;      ///< of the innovations
  std::size_t innovations = 0;    ///< how many positions were informative
};

/// Nothing if the paths together have fewer than 10 positions beyond the first two of each, or nothing in them moves or errs.
template <int D>
std::optional<NoiseFit> fit_noise(std::span<const MeasuredPath<D>> paths);

/// `options` with the noise that was found; a filter without noise parameters is returned as it is.
FilterOptions with_noise(const FilterOptions& options, const NoiseFit& fit);

}  // namespace marey::filter
