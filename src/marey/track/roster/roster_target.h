#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/LU>

#include "marey/core/ids.h"
#include "marey/core/observation.h"
#include "marey/core/time.h"
#include "marey/filter/any_filter.h"
#include "marey/track/roster/roster_tracker.h"

namespace marey::track::roster {

/// One point that the roster tracker follows.
template <int D>
struct RosterTarget {
  /// A newcomer is not reported; a provisional target, from the first frame, is, but has yet to prove that it is not a false point.
  enum class Standing { newcomer, provisional, established };

  TrackId id;
  std::string label;
  filter::AnyFilter<D> filter;
  double width;             ///< of its marker
  double typical_variance;  ///< of its observations
  Vector<D> last_position;  ///< where it was last seen
  double unobserved = 0;    ///< s, since then
  double detected = 0;      ///< s, in which it was
  double speed = 0;         ///< the highest of the last observations, fading, in units per s
  double travel = 0;        ///< how far it may have moved since it was last seen, at its own speed or that of the others
  std::optional<int> observation = {};  ///< in this frame
  std::optional<int> covered_by = {};   ///< the observation that it is taken to be behind
  std::optional<int> neighbour = {};    ///< its number among the rigid neighbours
  double predicted_variance = 0;        ///< while it is unseen and its rigid neighbours predict it: of that prediction, else 0
  int misfits = 0;                      ///< frames on end in which its rigid neighbours contradict its observation
  Timestamp since{};                    ///< its observations are one marker's, whichever, from here on
  Timestamp sure_until{};               ///< when its rigid neighbours last found that it is the one
  bool may_be_another = false;          ///< it came later: it may be a target that was lost, under a new name
  bool crowded = false;                 ///< another target is within a marker's width
  Standing standing = Standing::established;
  double score = 0;  ///< log-likelihood ratio of a target against clutter, until it is established

  /// Its last observations, the newest last: from them the filter is begun again without those that show a marker in part.
  struct Measured {
    Vector<D> location;
    Matrix<D> covariance;
    double dt = 0;      ///< s, since the one before
    bool whole = true;  ///< not smaller than the marker
  };
  /// What it was before it took a point that may as well be a false one; given back where the next frame does not confirm it.
  struct Undo {
    filter::AnyFilter<D> filter;
    Vector<D> last_position;
    double unobserved = 0;  ///< s
    double score = 0;       ///< log-likelihood ratio of its points since, against clutter
  };
  std::vector<Undo> undo = {};  ///< one or none

  static constexpr std::size_t kKept = 14, kMaxKept = 240;
  std::vector<Measured> measured =
      {};  ///< at most kMaxKept, for a slow marker is long in vanishing; of those whole the last kKept count

  bool on_roster() const { return standing != Standing::newcomer; }
  bool missed() const { return !observation && !covered_by; }
  /// Whether it may have moved to a place since it was last seen: the search goes no farther, however wide the filter's gate grows
  /// in the meantime. `slack` is what its place is uncertain by, beside its motion.
  bool within_reach(const Vector<D>& location, double slack) const {
    constexpr double kSpeedUp = 1.5;  // times the speed of before
    return (location - last_position).norm() <= kSpeedUp * travel + slack;
  }
  /// Whether it may be at a place, as far as is known where it went since it was last seen.
  bool near(const Vector<D>& location) const {
    constexpr double kSigmas = 4;
    const double variance = predicted_variance + filter.covariance().trace() / D + width * width / 16;
    return (location - filter.position()).squaredNorm() < kSigmas * kSigmas * variance;
  }
};

/// What one point is worth to the roster tracker: how large it is, how sure its place, and how likely it is clutter.
template <int D>
class RosterLikelihood {
 public:
  explicit RosterLikelihood(const RosterTrackerOptions& options) : options_(options) {}

  double width_of(const Observation<D>& observation) const {
    if constexpr (D == 2) {
      if (observation.box && !observation.box->empty()) return std::sqrt(observation.box->area());
    }
    return options_.marker_width;
  }

  Matrix<D> noise_of(const Observation<D>& observation) const {
    Matrix<D> R = *observation.covariance;
    R.diagonal().array() += options_.position_noise * options_.position_noise;
    return R;
  }

  /// A marker that shows in part, at the edge of what hides it, is smaller than it was, and its centre off by up to half of that:
  /// always to the same side, so that the filter would take it for a change of velocity.
  Matrix<D> noise_of(const Observation<D>& observation, const RosterTarget<D>& target) const {
    Matrix<D> R = noise_of(observation);
    R.diagonal().array() += target.predicted_variance;
    const double lost = target.width - width_of(observation);
    if (!shows_whole(target, observation)) R.diagonal().array() += kPartNoise * kPartNoise * lost * lost;
    const double growth = -lost - kWidthNoise * target.width;
    if (growth > 0) R.diagonal().array() += growth * growth;
    return R;
  }

  /// Of a point as it is seen.
  static double variance_of(const Observation<D>& observation) { return observation.covariance->trace() / D; }

  /// Whether the point is as large as the target, but for what the pixels' raster makes of it, and reported as well as it usually
  /// is: a disc that something begins to cover is a bad disc before it is a small one.
  bool shows_whole(const RosterTarget<D>& target, const Observation<D>& observation) const {
    if (D == 2 && variance_of(observation) > kPartVariance * target.typical_variance) return false;
    return target.width - width_of(observation) < kPartWidth * target.width + kPartPixels;
  }

  /// Whether the point may be a target that comes back.
  bool alike(const RosterTarget<D>& target, const Observation<D>& observation) const {
    const double ratio = width_of(observation) / target.width;
    return ratio < kMaxGrowth && ratio > 1 / kMaxGrowth;
  }

  /// Learns from the number of points in a frame that no target explains.
  void count_unexplained(double points) { unexplained_ += kClutterMemory * (points - unexplained_); }
  void widen_scene(const Vector<D>& location) { extent_ = std::max(extent_, location.cwiseAbs().maxCoeff()); }

  /// Whether so few false points are to be expected in one frame within `radius` of a place that a jump is trusted at once.
  bool trusts_jump(double radius) const {
    const double fraction = std::pow(radius, D) / std::max(std::pow(radius, D), std::pow(extent_, D));
    return unexplained_ * fraction <= kClutterLimit;
  }

  /// How much likelier the point is the target's than a false one, as a logarithm.
  double log_ratio(const RosterTarget<D>& target, const Vector<D>& location, const Matrix<D>& R) const {
    const Matrix<D> S = target.filter.innovation_covariance(R);
    const Vector<D> residual = location - target.filter.position();
    const double clutter_density = std::max(unexplained_, kMinClutterDensity) / std::pow(extent_, D);
    return -0.5 * (residual.dot(S.inverse() * residual) + std::log(S.determinant()) + D * std::log(2 * std::numbers::pi)) -
           std::log(clutter_density);
  }

  /// How much likelier it is that the target comes back at the point than that the point is a false one, as a logarithm.
  double log_return(double log_likelihood) const {
    return log_likelihood - std::log(std::max(unexplained_, kMinClutterDensity) / std::pow(extent_, D));
  }

  /// Whether there are this many false points that one that stands alone proves little.
  bool cluttered() const { return D == 2 && unexplained_ > kCluttered; }

  static constexpr double kWidthNoise = 0.2;   // of the width: what the pixels' raster makes of it
  static constexpr double kPartWidth = 0.08;   // of the width, and
  static constexpr double kPartPixels = 0.35;  // px less than it: it shows in part
  static constexpr double kPartVariance = 6;   // times the typical variance: likewise
  static constexpr double kPartNoise = 3;      // times what it has lost of its width: a marker's place that shows in part

 private:
  static constexpr double kMaxGrowth = 2.5;           // a lost marker comes back no larger, no smaller than by this
  static constexpr double kClutterMemory = 0.1;       // a frame
  static constexpr double kClutterLimit = 0.02;       // false points to be expected where a jump is still trusted at once
  static constexpr double kAtFirst = 0.5;             // false points a frame, before anything is known
  static constexpr double kCluttered = 0.05;          // false points a frame, from which a single one is doubted
  static constexpr double kMinClutterDensity = 0.01;  // false points a frame that are always thought possible

  RosterTrackerOptions options_;
  double unexplained_ = D == 2 ? kAtFirst : 0;  // points a frame that no target explains, a running mean
  double extent_ = 1;                           // of the scene, px
};

}  // namespace marey::track::roster
