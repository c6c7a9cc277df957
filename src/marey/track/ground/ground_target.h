// What every way of following people on the ground shares: one person, what an observation is worth to it, how it begins, goes on
// and ends. Who is given which observation is the business of gnn, jpda and mht.
//
// A pair of target and observation is gated by chi-square distance and by speed, and worth the logarithm of its likelihood against
// that of clutter: place, appearance, score. Cameras disagree about places, for good, by what their calibrations are wrong; that is
// no noise that a filter may average away, so it widens gates (`disagreement`) and is not learned from.
// An observation of another time is brought to the instant at the target's own velocity.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <Eigen/LU>

#include "marey/core/colour.h"
#include "marey/core/geometry.h"
#include "marey/core/observation.h"
#include "marey/core/track.h"
#include "marey/geometry/chi_square.h"
#include "marey/track/ground/ground_presence.h"
#include "marey/track/ground/ground_tracker.h"

namespace marey::track::ground {

/// One person who is followed. A value: hypotheses copy it.
template <typename F>
struct GroundTarget {
  TrackId id{};
  F filter;
  Timestamp born{};
  Timestamp last_seen{};                        ///< by any camera
  double evidence = 0;                          ///< grows with observations, shrinks with misses; until it is confirmed
  GroundPresence presence = {1, 1};             ///< whether it is there, and can be seen
  double away = 0;                              ///< s for which no camera could have seen it, since it was last seen
  double owed = 0;                              ///< s for which somebody should have seen it since then
  double missed = 0;                            ///< evidence lost at this instant
  double should = 0;                            ///< the greatest probability that a camera of this instant sees it
  bool confirmed = false;                       ///< there is a target at all
  double score = 1;                             ///< of the last observation
  CameraMask cameras = 0;                       ///< who saw it at this instant
  std::optional<Appearance> wears = {};         ///< learned over all that was seen of it
  std::optional<Appearance> seen_wearing = {};  ///< at this instant
};

/// An observation brought to the instant, m.
struct GroundPlace {
  Vector<2> value = Vector<2>::Zero();
  Matrix<2> covariance = Matrix<2>::Identity();
};

template <typename F>
class GroundRules {
 public:
  using Target = GroundTarget<F>;

  GroundRules(const GroundTrackerOptions& options, const typename F::Options& filter, int cameras)
      : options_(options),
        filter_(filter),
        gate_(geometry::chi_square_quantile(2, options.gate_probability)),
        disagreement_(cameras > 1 ? options.disagreement * options.disagreement : 0) {}

  const GroundTrackerOptions& options() const { return options_; }

  Target start(TrackId id, Timestamp time, const Observation<2>& seen) const {
    Target target{.id = id, .filter = F(filter_, seen.value, seen.covariance), .born = time, .last_seen = time};
    target.evidence = evidence_of(seen.score);
    note(target, seen);
    return target;
  }

  /// To the instant `dt` > 0 seconds after the one before.
  void predict(Target& target, double dt) const {
    target.filter.predict(dt);
    target.presence.predict(dt);
    if (target.cameras == 0) (target.should > 0 ? target.owed : target.away) += target.should > 0 ? dt * target.should : dt;
    target.cameras = 0;
    target.missed = 0;
    target.should = 0;
    target.seen_wearing.reset();
  }

  /// Where an observation made `late` seconds after the instant that the target was predicted to would have been then.
  GroundPlace at_instant(const Target& target, const Observation<2>& seen, double late) const {
    if (late == 0) return {seen.value, seen.covariance};
    const double strayed = std::pow(late * unsure_speed, 2);
    return {seen.value - late * target.filter.velocity(), seen.covariance + strayed * Matrix<2>::Identity()};
  }

  /// The logarithm of how much likelier the observation, at that place, is this target's than clutter; nothing outside the
  /// gate. A miss of this target is worth log(1 − detected · visible) in the same scale.
  std::optional<double> log_ratio(const Target& target, const Observation<2>& seen, const GroundPlace& place, Timestamp now) const {
    const Vector<2> residual = place.value - target.filter.position();
    Matrix<2> S = target.filter.innovation_covariance(place.covariance);
    S.diagonal().array() += disagreement_;
    const double determinant = S.determinant();
    if (!(determinant > 0)) return std::nullopt;
    const double distance = residual.dot(S.inverse() * residual);
    if (!(distance <= gate_) || !within_reach(target, residual, S, now)) return std::nullopt;
    double ratio = std::log(options_.detected / options_.clutter / (2 * std::numbers::pi)) - (distance + std::log(determinant)) / 2;
    if (target.wears && seen.appearance) ratio += alike(*target.wears, *seen.appearance);
    ratio -= weak_cost * (1 - std::clamp(seen.score, 0.0, 1.0));
    return target.confirmed ? ratio : ratio - newcomer_cost;
  }

  /// Nothing farther than this from the target can pass its gate, where no observation's covariance exceeds `widest`, m².
  double search_radius(const Target& target, double widest) const {
    const Matrix<2> P = target.filter.innovation_covariance(Matrix<2>::Zero());
    return std::sqrt(gate_ * (P.trace() + widest + disagreement_));
  }

  /// Takes in an observation, at that place, that is this target's.
  void correct(Target& target, const Observation<2>& seen, const GroundPlace& place, Timestamp now) const {
    target.filter.correct(place.value, place.covariance);
    take(target, seen, now);
  }

  /// All that `correct` does but for the filter.
  void take(Target& target, const Observation<2>& seen, Timestamp now) const {
    target.last_seen = now;
    target.owed = 0;
    target.away = 0;
    target.presence.see();
    target.evidence = std::min(most_evidence, target.evidence + evidence_of(seen.score));
    if (target.evidence >= options_.confirm) target.confirmed = true;
    note(target, seen);
  }

  /// A look brought nothing of this target, which was `visible` with that probability (ground_sight.h).
  void miss(Target& target, double visible) const {
    target.should = std::max(target.should, visible);
    target.presence.miss(visible * options_.detected);
    // Whoever is known may be hidden. Who is said to hide just where another is seen was a false alarm beside him.
    const double blame = target.confirmed || visible == 0 ? visible : 1;
    const double cost = std::min(miss_evidence * blame, miss_evidence - target.missed);
    target.missed += cost;
    target.evidence -= cost;
  }

  /// `other` turned out to be the same person.
  void absorb(Target& target, const Target& other) const {
    target.cameras |= other.cameras;
    target.last_seen = std::max(target.last_seen, other.last_seen);
    target.evidence = std::max(target.evidence, other.evidence);
    target.confirmed = target.confirmed || other.confirmed;
    if (!target.wears) target.wears = other.wears;
  }

  /// It has not been seen for too long, or there never was anybody.
  bool lost(const Target& target, Timestamp now) const {
    if (target.cameras != 0) return false;
    const double unseen = seconds(now - target.last_seen);
    if (!target.confirmed) return target.evidence < 0 || unseen > tentative_patience;
    const double patience = std::min(options_.patience, seconds(target.last_seen - target.born) + tentative_patience);
    return target.owed > patience || target.away > away_patience || unseen > 2 * options_.patience;
  }

  Track<2> report(const Target& target) const {
    Track<2> track;
    track.id = target.id;
    track.position = target.filter.position();
    track.velocity = target.filter.velocity();
    track.covariance = target.filter.covariance();
    track.state = target.cameras != 0 ? Track<2>::State::observed : Track<2>::State::predicted;
    track.confirmed = target.confirmed;
    track.score = target.score;
    track.cameras = target.cameras;
    track.appearance = target.seen_wearing;
    return track;
  }

 private:
  static double evidence_of(double score) { return 0.4 + 0.8 * std::clamp(score, 0.0, 1.0); }

  void note(Target& target, const Observation<2>& seen) const {
    target.score = seen.score;
    target.cameras |= mask_of(seen.camera);
    if (!seen.appearance) return;
    target.seen_wearing = seen.appearance;
    if (!target.wears) {
      target.wears = seen.appearance;
      return;
    }
    Appearance& learned = *target.wears;
    learned.lightness += colour_rate * (seen.appearance->lightness - learned.lightness);
    learned.a += colour_rate * (seen.appearance->a - learned.a);
    learned.b += colour_rate * (seen.appearance->b - learned.b);
    learned.deviation += colour_rate * (seen.appearance->deviation - learned.deviation);
  }

  /// As far as it can have gone since it was last seen.
  bool within_reach(const Target& target, const Vector<2>& residual, const Matrix<2>& S, Timestamp now) const {
    const double reach = options_.max_speed * seconds(now - target.last_seen);
    return residual.squaredNorm() <= std::pow(reach + 3 * std::sqrt(S.trace()), 2);
  }

  /// Logarithm of how much likelier two colours are one person's than two people's.
  static double alike(const Appearance& a, const Appearance& b) {
    const double same = (a.deviation * a.deviation + b.deviation * b.deviation) / 4 + light * light;
    const double other = same + people_differ * people_differ;
    const double squared = (perceived(a) - perceived(b)).squaredNorm();
    return std::clamp(1.5 * std::log(other / same) - squared / 2 * (1 / same - 1 / other), -most_colour, most_colour);
  }

  static constexpr double unsure_speed = 1;     // m/s by which a target's velocity may be wrong within a frame's time
  static constexpr double weak_cost = 2;        // a detector's doubt
  static constexpr double newcomer_cost = 1;    // a confirmed target has the first claim
  static constexpr double miss_evidence = 0.7;  // at most, an instant
  static constexpr double most_evidence = 10;
  static constexpr double tentative_patience = 0.4;  // s
  static constexpr double away_patience = 3;         // s out of all pictures, after which who comes in is somebody else
  static constexpr float colour_rate = 0.05F;        // of a new colour in what is learned
  static constexpr double light = 6;                 // of perceived colour: what sun, shade and another camera make of one
  static constexpr double people_differ = 20;        // of perceived colour: spread over people
  static constexpr double most_colour = 4;           // colours alone decide no more than this

  GroundTrackerOptions options_;
  typename F::Options filter_;
  double gate_;
  double disagreement_;  // m², per axis
};

}  // namespace marey::track::ground
