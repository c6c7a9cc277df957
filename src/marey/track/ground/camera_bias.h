// What each camera is wrong about the ground, by place, learned from a recording in which several cameras see the same people.
//
// Calibrations err smoothly: a homography that was clicked on one corner is half a metre off at the other, permanently. Two
// cameras' places of one person then differ by the difference of their errors there, the one who it is. People stand mostly farther
// apart than that, so that places of two cameras that are each other's nearest, and the second nearest much farther, are one
// person's; the smooth errors that make all such pairs agree best are found by turns: pair, take half of each difference over into
// either camera's field, pair again with a smaller gate, from one shift of the whole image down to a field (iterated closest
// points, Besl & McKay 1992, with smooth displacements). Fields shrink to zero where nothing was seen. They are kept only if they
// explain pairs of time intervals that they were not learned from. What then remains is of two kinds. What is still there a
// tenth of a second later, of gait, posture, the detector's habit or the calibration, no filter may average away: the covariance of
// two cameras' difference about one person at the two instants, from medians of their sum and difference, so that neither wrong
// pairs nor the gate's edge bias it. The rest is noise, and shows how far each camera's covariances are to be trusted. Where all
// cameras err alike nothing can be seen of it here. Cost: pairs of cameras times observations² for each of some hundred instants, a
// dozen times.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/core/observation.h"
#include "marey/track/ground/ground_field.h"
#include "marey/track/ground/ground_instant.h"

namespace marey::track::ground {

class CameraBias {
 public:
  CameraBias() = default;

  /// From what `cameras` cameras saw. Nothing is learned from fewer than some hundred pairs.
  static CameraBias learn(std::span<const GroundInstant> instants, int cameras);

  /// Whether cameras were found to disagree, or to agree, at all.
  bool learned() const { return !noise_.empty(); }
  /// The observation without what its camera is wrong, as uncertain as such observations are.
  Observation<2> corrected(Observation<2> detected) const;
  /// Standard deviation per axis and camera of what lasts of the disagreement, m: what is still there a tenth of a second later, or
  /// at the next instant at low rates; a share of all errors where too few people can be reported again then. Nothing if nothing
  /// was learned.
  std::optional<double> disagreement() const { return disagreement_; }

 private:
  std::vector<GroundField> bias_;  // by camera, m; none where they were not worth it
  std::vector<double> noise_;      // by camera: factor on standard deviations
  std::optional<double> disagreement_;
};

}  // namespace marey::track::ground
