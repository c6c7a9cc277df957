#pragma once

#include <optional>
#include <span>
#include <vector>

#include "marey/core/geometry.h"

namespace marey::track::ground {

/// What two cameras say of one person at an instant and a little later.
struct LinkedDifferences {
  int a = 0, b = 0;         ///< the cameras
  Vector<2> first, second;  ///< m: where b has the person less where a has them, at either instant
  Matrix<2> covariance;     ///< m², of `first` and `second` together, as stated
};

/// How errors divide into what lasts from the one instant to the other and what does not.
struct LastingDisagreement {
  std::optional<double> deviation;  ///< m per axis and camera, of what lasts; nothing if links are too few
  std::vector<double> noise;  ///< by camera, 1 or more: what stated deviations are to be multiplied by, for what does not last
};

/// Robust against a fifth of wrong links. The covariance of a difference at two instants is a quarter of what the variance of their
/// sum exceeds that of their change by; both variances come from medians, along the axes of the stated covariance.
LastingDisagreement lasting_disagreement(std::span<const LinkedDifferences> links, int cameras);

}  // namespace marey::track::ground
