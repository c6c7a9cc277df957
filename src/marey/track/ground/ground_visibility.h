#pragma once

#include <memory>
#include <span>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/core/ground_views.h"
#include "marey/core/observation.h"
#include "marey/track/ground/ground_tracker.h"

namespace marey::track::ground {

/// What each camera can see of the ground: a target outside its image, or behind another that is nearer, is not missed by it.
class GroundVisibility {
 public:
  explicit GroundVisibility(std::shared_ptr<const GroundViews> views) : views_(std::move(views)) {}

  int cameras() const { return views_->cameras(); }

  /// Throws Error if a view is of none of the cameras, or not finite.
  void check(const CameraObservations& view) const;

  /// Turns to one camera's view at the time of its frame: of its observations those with scores of at least `min_score` may stand
  /// before others. The camera must be one of the rig's.
  void set_view(const CameraObservations& of, double min_score);

  /// The probability, in [0, 1], that nothing keeps this camera from seeing a person who stands at `place`, m, and is not one of
  /// those whose boxes it sees: 0 outside the image, ½ at its border, little behind another's box.
  double visible(const Vector<2>& location) const;

 private:
  double covered(const Vector<2>& foot) const;

  static constexpr double border = 0.02;          // of the image's width: this near its edge half of the people are missed
  static constexpr double hidden_fraction = 0.3;  // of a body behind another, from which on it is likely to be missed
  static constexpr double observed_hidden = 0.1;  // probability that a person hidden so is seen nevertheless

  std::shared_ptr<const GroundViews> views_;
  const GroundView* view_ = nullptr;
  std::vector<Box> boxes_;  // of this view
};

/// The views' numbers, the most certain places first: people who stand close together are distinguished by them, and they
/// guides what the others are taken for.
std::vector<int> surest_first(std::span<const CameraObservations> views);

}  // namespace marey::track::ground
