#pragma once

#include <optional>
#include <span>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/evaluate/evaluation.h"

namespace marey::evaluate {

/// Where a person or a marker was at one instant. On the ground the third coordinate is 0.
struct TargetPosition {
  std::int32_t frame = 0;
  std::int32_t id = 0;
  Vector<3> location = Vector<3>::Zero();  ///< m
  std::optional<Vector<3>> velocity = {};  ///< m/s
};

inline Vector<3> on_ground(const Vector<2>& location) {
  return {location.x(), location.y(), 0};
}

/// What happened to one true target.
struct TargetFate {
  int id = 0;
  std::optional<int> track;  ///< the one that the identity scores give them permanently
  std::int64_t frames = 0;
  std::int64_t found = 0;     ///< frames in which some track was near
  std::int64_t agreeing = 0;  ///< frames in which their own track was
  std::int64_t switches = 0;
  /// Whether the identity stays right: no switch, and their own track finds them in at least 80 % of their frames.
  bool kept() const { return track && switches == 0 && 5 * agreeing >= 4 * frames; }
};

/// Root mean square, median and 95th percentile of an error's amount.
struct ErrorSpread {
  double rms = 0, median = 0, p95 = 0;
};

/// Everything that `marey evaluate --distance` reports of places.
struct GroundEvaluation {
  Evaluation scores;  ///< as of boxes, with places for boxes; MOTP is a mean distance, m
  std::vector<TargetFate> people;
  /// Over CLEAR's matches; none without.
  std::optional<ErrorSpread> position;  ///< m
  std::optional<ErrorSpread> speed;     ///< of the amount of the velocity, m/s, where both are known
  std::optional<ErrorSpread> velocity;  ///< of the difference of the velocities, m/s, likewise
};

/// Evaluates places by their distance: up to `farthest` m they may match, and for HOTA the similarity is 1 − distance / farthest.
/// Both are ordered by frame, and an id stands once a frame. Cost as of `evaluate`.
GroundEvaluation evaluate_ground(std::span<const TargetPosition> truth, std::span<const TargetPosition> tracks, double farthest);

}  // namespace marey::evaluate
