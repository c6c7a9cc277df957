#pragma once

#include <span>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/core/observation.h"
#include "marey/geometry/ground_view.h"
#include "marey/track/ground/ground_tracker.h"

namespace marey::track::ground {

/// What each camera can see of the ground: a target outside its picture, or behind another that is nearer, is not missed by it.
class GroundVisibility {
 public:
  explicit GroundVisibility(std::vector<GroundView> views) : views_(std::move(views)) {}

  int cameras() const { return static_cast<int>(views_.size()); }

  /// Throws Error where a view is of none of the cameras, or not finite.
  void check(const CameraObservations& view) const;

  /// Turns to one camera's view: `seen` are its observations, of which those with scores of at least `least_score` may stand before
  /// others. The camera must be one of the rig's.
  void set_view(CameraId camera, std::span<const Observation<2>> seen, double least_score);

  /// The probability, in [0, 1], that nothing keeps this camera from seeing a person who stands at `place`, m, and is not one of
  /// those whose boxes it sees: 0 outside the picture, ½ at its border, little behind another's box.
  double visible(const Vector<2>& place) const;

 private:
  double covered(const Vector<2>& foot) const;

  static constexpr double border = 0.02;       // of the picture's width: this near its edge half of the people are missed
  static constexpr double hidden_share = 0.3;  // of a body behind another, from which on it is likely to be missed
  static constexpr double seen_hidden = 0.1;   // probability that a person hidden so is seen nevertheless

  std::vector<GroundView> views_;
  const GroundView* view_ = nullptr;
  std::vector<Box> boxes_;  // of this view
};

/// The views' numbers, those first whose places are surest: who stands close together is told apart by them, and what they say
/// guides what the others are taken for.
std::vector<int> surest_first(std::span<const CameraObservations> views);

}  // namespace marey::track::ground
