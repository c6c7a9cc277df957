// What all trackers of people on the ground share: one target, what an observation is worth to it, how it begins, continues
// and ends. Which observation a target is given is the business of gnn, jpda and mht.
//
// A pair of target and observation is gated by chi-square distance and by speed, and worth the logarithm of its likelihood against
// that of clutter: place, appearance, score. Cameras disagree about places, permanently, by what their calibrations are wrong; that
// is not noise that a filter may average away, so it widens gates (`disagreement`) and is not learned from. An observation of
// another time is brought to the instant at the target's own velocity.
#pragma once

#include <optional>

#include "marey/core/colour.h"
#include "marey/core/geometry.h"
#include "marey/core/observation.h"
#include "marey/core/track.h"
#include "marey/filter/any_filter.h"
#include "marey/track/evidence.h"
#include "marey/track/ground/ground_presence.h"
#include "marey/track/ground/ground_tracker.h"

namespace marey::track::ground {

/// One person who is followed. A value: hypotheses copy it.
struct GroundTarget {
  TrackId id{};
  filter::AnyFilter<2> filter;
  Timestamp initiated{};
  Timestamp last_observed{};  ///< by any camera
  Evidence evidence;
  GroundPresence presence = {1, 1};               ///< whether it is there, and can be seen
  double out_of_view = 0;                         ///< s for which no camera could have seen it, since it was last seen
  double overdue = 0;                             ///< s for which a camera should have seen it since then
  double missed = 0;                              ///< evidence lost at this instant
  double visibility = 0;                          ///< the greatest probability that a camera of this instant sees it
  double score = 1;                               ///< of the last observation
  CameraMask cameras = 0;                         ///< those that saw it at this instant
  std::optional<Appearance> appearance = {};      ///< learned over all that was seen of it
  std::optional<Appearance> appearance_now = {};  ///< at this instant

  bool confirmed() const { return evidence.confirmed(); }
};

/// An observation brought to the instant, m.
struct GroundPosition {
  Vector<2> value = Vector<2>::Zero();
  Matrix<2> covariance = Matrix<2>::Identity();
};

class GroundRules {
 public:
  using Target = GroundTarget;

  GroundRules(const GroundTrackerOptions& options, int cameras);

  const GroundTrackerOptions& options() const { return options_; }

  Target start(TrackId id, Timestamp time, const Observation<2>& detected) const;

  /// To the instant `dt` > 0 seconds after the one before.
  void predict(Target& target, double dt) const;

  /// Where an observation made `late` seconds after the instant that the target was predicted to would have been then.
  GroundPosition at_instant(const Target& target, const Observation<2>& detected, double late) const;

  /// The logarithm of how much likelier the observation, at that place, is this target's than clutter; nothing outside the
  /// gate. A miss of this target is worth log(1 − detected · visible) in the same scale.
  std::optional<double> log_ratio(const Target& target, const Observation<2>& detected, const GroundPosition& location,
                                  Timestamp now) const;

  /// Nothing farther than this from the target can pass its gate, where no observation's covariance exceeds `widest`, m².
  double search_radius(const Target& target, double widest) const;

  /// Takes in an observation, at that place, that is this target's.
  void correct(Target& target, const Observation<2>& detected, const GroundPosition& location, Timestamp now) const;

  /// All that `correct` does but for the filter.
  void take(Target& target, const Observation<2>& detected, Timestamp now) const;

  /// A view brought nothing of this target, which was `visible` with that probability (ground_visibility.h).
  void miss(Target& target, double visible) const;

  /// `other` turned out to be the same person.
  void absorb(Target& target, const Target& other) const;

  /// It has not been seen for too long, or there never was a target.
  bool lost(const Target& target, Timestamp now) const;

  Track<2> report(const Target& target) const;

 private:
  bool within_reach(const Target& target, const Vector<2>& residual, const Matrix<2>& S, Timestamp now) const;

  GroundTrackerOptions options_;
  double gate_;
  double disagreement_;  // m², per axis
};

}  // namespace marey::track::ground
