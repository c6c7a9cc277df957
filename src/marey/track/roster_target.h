#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include <Eigen/LU>

#include "marey/core/ids.h"
#include "marey/core/observation.h"
#include "marey/track/roster_tracker.h"

namespace marey::track {

/// One point that the roster tracker follows.
template <typename F>
struct RosterTarget {
  static constexpr int kNone = -1;

  /// A newcomer is not reported; a provisional target, from the first frame, is, but has yet to prove that it is no false point.
  enum class Standing { newcomer, provisional, established };

  TrackId id;
  std::string label;
  F filter;
  double width;                             ///< of its marker
  Vector<F::dimension> last_place;  ///< where it was last seen
  double unseen = 0;                        ///< s, since then
  double seen = 0;                          ///< s, in which it was
  int observation = kNone;                  ///< in this frame
  int covered_by = kNone;                   ///< the observation that it is taken to be behind
  std::optional<int> member = {};           ///< its number among companions
  double guided = 0;     ///< while it is unseen: variance of where its companions say that it is; 0 where they do not
  int doubts = 0;        ///< frames on end in which companions said that what is followed is somebody else
  bool crowded = false;  ///< another target is within a marker's width
  Standing standing = Standing::established;
  double score = 0;  ///< log-likelihood ratio of a target against clutter, until it is established

  bool on_roster() const { return standing != Standing::newcomer; }
};

/// What the roster tracker makes of one point: how large it is, how sure its place, and how likely it is nobody's.
template <typename F>
class RosterSight {
 public:
  static constexpr int D = F::dimension;

  explicit RosterSight(const RosterTrackerOptions& options) : options_(options) {}

  double width_of(const Observation<D>& observation) const {
    if constexpr (D == 2) {
      if (observation.box) return std::sqrt(observation.box->area());
    }
    return options_.marker_width;
  }

  Matrix<D> noise_of(const Observation<D>& observation) const {
    Matrix<D> R = observation.covariance;
    R.diagonal().array() += options_.place_noise * options_.place_noise;
    return R;
  }

  /// A marker that shows in part, at the edge of what hides it, is smaller than it was, and its centre off by up to half of that.
  Matrix<D> noise_of(const Observation<D>& observation, const RosterTarget<F>& target) const {
    Matrix<D> R = noise_of(observation);
    R.diagonal().array() += target.guided;
    const double change = std::abs(width_of(observation) - target.width) - kWidthNoise * target.width;
    if (change > 0) R.diagonal().array() += change * change;
    return R;
  }

  /// Whether the point may be a target that comes back.
  bool alike(const RosterTarget<F>& target, const Observation<D>& observation) const {
    const double ratio = width_of(observation) / target.width;
    return ratio < kMostGrowth && ratio > 1 / kMostGrowth;
  }

  /// Learns from the number of points in a frame that no target explains.
  void count_unexplained(double points) { unexplained_ += kClutterMemory * (points - unexplained_); }
  void widen_scene(const Vector<D>& place) { extent_ = std::max(extent_, place.cwiseAbs().maxCoeff()); }

  /// Whether so few false points are to be expected in one frame within `radius` of a place that a jump is believed at once.
  bool believes_jump(double radius) const {
    const double share = std::pow(radius, D) / std::max(std::pow(radius, D), std::pow(extent_, D));
    return unexplained_ * share <= kClutterLimit;
  }

  /// How much likelier the point is the target's than a false one, as a logarithm.
  double log_ratio(const RosterTarget<F>& target, const Vector<D>& place, const Matrix<D>& R) const {
    const Matrix<D> S = target.filter.innovation_covariance(R);
    const Vector<D> residual = place - target.filter.position();
    const double clutter_density = std::max(unexplained_, kLeastClutter) / std::pow(extent_, D);
    return -0.5 * (residual.dot(S.inverse() * residual) + std::log(S.determinant()) + D * std::log(2 * std::numbers::pi)) -
           std::log(clutter_density);
  }

  static constexpr double kWidthNoise = 0.2;  // of the width: what the pixels' raster makes of it

 private:
  static constexpr double kMostGrowth = 2.5;     // a lost marker comes back no larger, no smaller than by this
  static constexpr double kClutterMemory = 0.1;  // a frame
  static constexpr double kClutterLimit = 0.02;  // false points to be expected where a jump is still believed at once
  static constexpr double kLeastClutter = 0.01;  // false points a frame that are always thought possible

  RosterTrackerOptions options_;
  double unexplained_ = 0;  // points a frame that nobody explains, a running mean
  double extent_ = 1;       // of the scene, px
};

}  // namespace marey::track
