#include "marey/track/ground/ground_target.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/LU>

#include "marey/core/colour.h"
#include "marey/geometry/chi_square.h"

namespace marey::track::ground {
namespace {

constexpr double kVelocityError = 1;      // m/s by which a target's velocity may be wrong within a frame's time
constexpr double kLowScoreCost = 2;       // log-likelihood that a detector's doubt costs, at most
constexpr double kOutOfViewLimit = 3;     // s out of all images, after which a person that comes in is another
constexpr float kAppearanceRate = 0.05F;  // of a new colour in the learned one
constexpr double kLightSpread = 6;        // of perceived colour: what sun, shade and another camera make of one
constexpr double kPeopleSpread = 20;      // of perceived colour: spread over people
constexpr double kMaxOfColour = 4;        // colours alone decide no more than this

/// Logarithm of how much likelier two colours are one person's than two people's.
double appearance_ratio(const Appearance& a, const Appearance& b) {
  const double same = (a.deviation * a.deviation + b.deviation * b.deviation) / 4 + kLightSpread * kLightSpread;
  const double other = same + kPeopleSpread * kPeopleSpread;
  const double squared = (perceived(a) - perceived(b)).squaredNorm();
  return std::clamp(1.5 * std::log(other / same) - squared / 2 * (1 / same - 1 / other), -kMaxOfColour, kMaxOfColour);
}

void note(GroundTarget& target, const Observation<2>& detected) {
  target.score = detected.score;
  target.cameras |= mask_of(detected.camera);
  if (!detected.appearance) return;
  target.appearance_now = detected.appearance;
  if (!target.appearance) {
    target.appearance = detected.appearance;
    return;
  }
  if (detected.shared) return;  // may be in part another's
  Appearance& learned = *target.appearance;
  learned.lightness += kAppearanceRate * (detected.appearance->lightness - learned.lightness);
  learned.a += kAppearanceRate * (detected.appearance->a - learned.a);
  learned.b += kAppearanceRate * (detected.appearance->b - learned.b);
  learned.deviation += kAppearanceRate * (detected.appearance->deviation - learned.deviation);
}

}  // namespace

GroundRules::GroundRules(const GroundTrackerOptions& options, int cameras)
    : options_(options),
      gate_(geometry::chi_square_quantile(2, options.gate_probability)),
      disagreement_(cameras > 1 ? options.disagreement * options.disagreement : 0) {}

GroundTarget GroundRules::start(TrackId id, Timestamp time, const Observation<2>& detected) const {
  Target target{.id = id,
                .filter = {options_.filter, detected.value, *detected.covariance},
                .initiated = time,
                .last_observed = time,
                .evidence = Evidence(detected.score, options_.evidence)};
  note(target, detected);
  return target;
}

void GroundRules::predict(Target& target, double dt) const {
  target.filter.predict(dt);
  target.presence.predict(dt);
  if (target.cameras == 0)
    (target.visibility > 0 ? target.overdue : target.out_of_view) += target.visibility > 0 ? dt * target.visibility : dt;
  target.cameras = 0;
  target.missed = 0;
  target.visibility = 0;
  target.appearance_now.reset();
}

GroundPosition GroundRules::at_instant(const Target& target, const Observation<2>& detected, double late) const {
  if (late == 0) return {detected.value, *detected.covariance};
  const double strayed = std::pow(late * kVelocityError, 2);
  return {detected.value - late * target.filter.velocity(), *detected.covariance + strayed * Matrix<2>::Identity()};
}

std::optional<double> GroundRules::log_ratio(const Target& target, const Observation<2>& detected, const GroundPosition& location,
                                             Timestamp now) const {
  const Vector<2> residual = location.value - target.filter.position();
  Matrix<2> S = target.filter.innovation_covariance(location.covariance);
  S.diagonal().array() += disagreement_;
  const double determinant = S.determinant();
  if (!(determinant > 0)) return std::nullopt;
  const double distance = residual.dot(S.inverse() * residual);
  if (!(distance <= gate_) || !within_reach(target, residual, S, now)) return std::nullopt;
  double ratio = std::log(options_.detected / options_.clutter / (2 * std::numbers::pi)) - (distance + std::log(determinant)) / 2;
  if (target.appearance && detected.appearance) {
    ratio += appearance_ratio(*target.appearance, *detected.appearance);
    if (options_.teams) ratio += options_.teams->same(*target.appearance, *detected.appearance);
  }
  ratio -= kLowScoreCost * (1 - std::clamp(detected.score, 0.0, 1.0));
  return target.confirmed() ? ratio : ratio - options_.evidence.newcomer_cost;
}

double GroundRules::search_radius(const Target& target, double widest) const {
  const Matrix<2> P = target.filter.innovation_covariance(Matrix<2>::Zero());
  return std::sqrt(gate_ * (P.trace() + widest + disagreement_));
}

void GroundRules::correct(Target& target, const Observation<2>& detected, const GroundPosition& location, Timestamp now) const {
  target.filter.correct(location.value, location.covariance);
  take(target, detected, now);
}

void GroundRules::take(Target& target, const Observation<2>& detected, Timestamp now) const {
  target.last_observed = now;
  target.overdue = 0;
  target.out_of_view = 0;
  target.presence.observe_frame();
  target.evidence.observe_frame(detected.score, options_.evidence);
  note(target, detected);
}

void GroundRules::miss(Target& target, double visible) const {
  target.visibility = std::max(target.visibility, visible);
  target.presence.miss(visible * options_.detected);
  // A confirmed target may be hidden. One that is said to hide just where another is seen was a false alarm beside it.
  const double blame = target.confirmed() || visible == 0 ? visible : 1;
  const double cost = std::min(options_.evidence.miss * blame, options_.evidence.miss - target.missed);
  target.missed += cost;
  target.evidence.miss(cost);
}

void GroundRules::absorb(Target& target, const Target& other) const {
  target.cameras |= other.cameras;
  target.last_observed = std::max(target.last_observed, other.last_observed);
  target.evidence.absorb(other.evidence);
  if (!target.appearance) target.appearance = other.appearance;
}

bool GroundRules::lost(const Target& target, Timestamp now) const {
  if (target.cameras != 0) return false;
  const double unobserved = seconds(now - target.last_observed);
  if (!target.confirmed()) return target.evidence.refuted() || unobserved > options_.evidence.tentative_patience;
  const double patience = options_.evidence.patience(options_.patience, seconds(target.last_observed - target.initiated));
  return target.overdue > patience || target.out_of_view > kOutOfViewLimit || unobserved > 2 * options_.patience;
}

Track<2> GroundRules::report(const Target& target) const {
  Track<2> track;
  track.id = target.id;
  track.position = target.filter.position();
  track.velocity = target.filter.velocity();
  track.covariance = target.filter.covariance();
  track.provenance = target.cameras != 0 ? Provenance::measured : Provenance::predicted;
  track.confirmed = target.confirmed();
  track.score = target.score;
  track.cameras = target.cameras;
  track.appearance = target.appearance_now;
  return track;
}

/// As far as it can have gone since it was last seen.
bool GroundRules::within_reach(const Target& target, const Vector<2>& residual, const Matrix<2>& S, Timestamp now) const {
  const double reach = options_.max_speed * seconds(now - target.last_observed);
  return residual.squaredNorm() <= std::pow(reach + 3 * std::sqrt(S.trace()), 2);
}

}  // namespace marey::track::ground
