// The tracker of markers: a fixed cast of points that look alike, so that only motion tells them apart.
//
// Each frame: (1) predict; (2) claim: the assignment that is globally the likeliest, of points within the search areas; (3) meet: a
// target without a point whose place is covered by another's point is taken to be behind it; while two are that close neither's
// velocity is believed to the point they share, so that each comes out with the motion it went in with; (4) find: targets that are
// missed and points that nobody claims are brought together within the reach of the greatest speed, at once where false
// points are rare, else once the point has proved to stay; (5) correct; (6) start newcomers from what is left.
// That nobody on the roster dies is what carries a name across a barrier of any width, and through a turn too sharp for a filter.
// Cost: near linear in targets + points while search areas hold few points; the search for the lost is lost × unclaimed.
#include "marey/track/roster_tracker.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>

#include <Eigen/LU>

#include "marey/assign/gated_assignment.h"
#include "marey/assign/point_grid.h"
#include "marey/core/error.h"

namespace marey {
namespace {

template <typename F>
class RosterTracker final : public Tracker<F::dimension> {
 public:
  static constexpr int D = F::dimension;

  RosterTracker(const RosterTrackerOptions& options, const typename F::Options& filter_options)
      : options_(options), filter_options_(filter_options) {
    std::set<std::string> seen;
    for (const std::string& label : options.labels) {
      if (!seen.insert(label).second) throw Error("the label \"{}\" occurs twice; every marker needs a name of its own", label);
    }
  }

  std::span<const Track<D>> step(Timestamp now, std::span<const Observation<D>> seen) override {
    predict_to(now);
    if (targets_.empty()) {
      start_roster(seen);
    } else {
      claim(seen);
      meet(seen);
      find_lost(seen);
      correct(seen);
      judge_newcomers();
      start_unclaimed(seen);
    }
    return report();
  }

  std::span<const Track<D>> expected(Timestamp now) override {
    const double dt = now_ ? seconds(now - *now_) : 0.0;
    tracks_.clear();
    for (const Target& target : targets_) {
      F ahead = target.filter;
      ahead.predict(dt);
      tracks_.push_back(track_of(target, ahead, Track<D>::State::predicted));
    }
    return tracks_;
  }

 private:
  static constexpr int kNone = -1;

  /// A newcomer is not reported; a provisional target, from the first frame, is, but has yet to prove that it is no false point.
  enum class Standing { newcomer, provisional, established };

  struct Target {
    TrackId id;
    std::string label;
    F filter;
    double width;             // of its marker
    Vector<D> last_place;     // where it was last seen
    double unseen = 0;        // s, since then
    int observation = kNone;  // in this frame
    int covered_by = kNone;   // the observation that it is taken to be behind
    bool crowded = false;     // another target is within a marker's width
    Standing standing = Standing::established;
    double score = 0;  // log-likelihood ratio of a target against clutter, until it is established

    bool on_roster() const { return standing != Standing::newcomer; }
  };

  void predict_to(Timestamp now) {
    if (now_ && now <= *now_) {
      throw Error("the frame at {:.6f} s does not come after the one at {:.6f} s; the times of frames must grow", seconds(now),
                  seconds(*now_));
    }
    dt_ = now_ ? seconds(now - *now_) : 0.0;
    now_ = now;
    for (Target& target : targets_) {
      // A lost target drifts on for a while; then it is waited for where that led, not flown out of the picture.
      if (target.unseen < kCoast) target.filter.predict(dt_);
      target.unseen += dt_;
      target.observation = target.covered_by = kNone;
      target.crowded = false;
    }
  }

  void start_roster(std::span<const Observation<D>> seen) {
    if (seen.empty()) return;
    if (seen.size() < options_.labels.size()) {
      throw Error("there are {} labels, but {} markers are seen in the first frame; give as many labels as markers, or fewer",
                  options_.labels.size(), seen.size());
    }
    std::vector<int> order(seen.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](int a, int b) {
      return std::lexicographical_compare(seen[a].value.begin(), seen[a].value.end(), seen[b].value.begin(), seen[b].value.end());
    });
    for (const int index : order) {
      start(seen[index], index, options_.labels.empty() ? Standing::provisional : Standing::established);
      const auto number = static_cast<std::size_t>(next_id_ - 2);
      targets_.back().label = number < options_.labels.size() ? options_.labels[number] : std::string();
    }
  }

  void start(const Observation<D>& observation, int index, Standing standing) {
    targets_.push_back({.id = TrackId{next_id_++},
                        .label = {},
                        .filter = F(filter_options_, observation.value, noise_of(observation)),
                        .width = width_of(observation),
                        .last_place = observation.value,
                        .observation = index,
                        .standing = standing});
  }

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
  Matrix<D> noise_of(const Observation<D>& observation, const Target& target) const {
    Matrix<D> R = noise_of(observation);
    const double change = std::abs(width_of(observation) - target.width) - kWidthNoise * target.width;
    if (change > 0) R.diagonal().array() += square(change);
    return R;
  }

  bool alike(const Target& target, const Observation<D>& observation) const {
    const double ratio = width_of(observation) / target.width;
    return ratio < kMostGrowth && ratio > 1 / kMostGrowth;
  }

  void claim(std::span<const Observation<D>> seen) {
    points_.clear();
    for (const Observation<D>& point : seen) points_.push_back(point.value);
    const bool few = targets_.size() * seen.size() <= kFewPairs;
    if (!few) grid_.build(points_, 2 * options_.marker_width);
    pairs_.clear();
    const Spread spread = spread_of(seen);
    for (int row = 0; row < std::ssize(targets_); ++row) {
      const double reach = reach_of(targets_[row], spread);
      const auto consider = [&](int column) {
        if ((points_[column] - targets_[row].filter.position()).squaredNorm() > reach * reach) return;
        const double worth = gain(targets_[row], seen[column]);
        if (worth > 0) pairs_.push_back({row, column, worth});
      };
      if (few) {
        for (int column = 0; column < std::ssize(seen); ++column) consider(column);
      } else {
        grid_.for_each_near(targets_[row].filter.position(), search_radius(targets_[row]), consider);
      }
    }
    claimed_.assign(seen.size(), 0);
    const auto columns = assigner_.assign(static_cast<int>(targets_.size()), static_cast<int>(seen.size()), pairs_);
    for (int row = 0; row < std::ssize(targets_); ++row) {
      if (columns[row] == GatedAssigner::nobody) continue;
      targets_[row].observation = columns[row];
      claimed_[columns[row]] = 1;
    }
  }

  /// What bounds every observation's covariance in this frame.
  struct Spread {
    double variance = 0;
    double narrowest = 0, widest = 0;  // marker
  };

  Spread spread_of(std::span<const Observation<D>> seen) const {
    Spread spread;
    for (const Observation<D>& point : seen) {
      const double width = width_of(point);
      spread.variance = std::max(spread.variance, noise_of(point).trace());
      spread.narrowest = &point == seen.data() ? width : std::min(spread.narrowest, width);
      spread.widest = std::max(spread.widest, width);
    }
    return spread;
  }

  /// No pair farther apart than this can be worth anything: asked first, because it costs least.
  double reach_of(const Target& target, const Spread& spread) const {
    const double fastest = options_.max_speed * target.unseen + target.width;
    if constexpr (requires { target.filter.search_reach(0.0); }) {
      const double change = std::max(spread.widest - target.width, target.width - spread.narrowest) - kWidthNoise * target.width;
      return std::min(fastest, target.filter.search_reach(spread.variance + square(std::max(0.0, change))));
    } else {
      return fastest;
    }
  }

  /// The farthest that a point in the search area can be: the gate's own radius along its longest axis.
  double search_radius(const Target& target) const {
    const Matrix<D> S = target.filter.innovation_covariance(Matrix<D>::Zero());
    return std::min(kWidestGate * std::sqrt(S.trace()) + 2 * target.width, options_.max_speed * target.unseen + target.width);
  }

  /// What the pair is worth: the logarithm of its likelihood, above that at the border of the search area.
  double gain(const Target& target, const Observation<D>& point) const {
    const Vector<D> residual = point.value - target.filter.position();
    if (residual.squaredNorm() > square(options_.max_speed * target.unseen + target.width)) return 0;
    const Matrix<D> R = noise_of(point, target);
    if (target.filter.gate_distance(point.value, R) > 1) return 0;
    if (target.unseen > 1.5 * dt_ && expected_clutter(residual.norm() + target.width) > kClutterLimit) return 0;
    const Matrix<D> S = target.filter.innovation_covariance(R);
    const double cost = residual.dot(S.inverse() * residual) + std::log(S.determinant() / square(reference_variance()));
    return std::max(1e-3, kRoom - cost) + (target.on_roster() ? kRoom : 0);
  }

  double reference_variance() const { return square(options_.marker_width); }

  void meet(std::span<const Observation<D>> seen) {
    mark_crowded();
    for (Target& target : targets_) {
      if (target.observation != kNone || !target.crowded) continue;
      double nearest = target.width;
      for (const Target& other : targets_) {
        if (other.observation == kNone || other.id == target.id) continue;
        const Observation<D>& point = seen[other.observation];
        const double distance = (point.value - target.filter.position()).norm();
        const double reach = 0.5 * (width_of(point) + target.width);
        if (distance < reach && distance < nearest) {
          nearest = distance;
          target.covered_by = other.observation;
        }
      }
    }
  }

  /// Targets that are expected, or were just seen, within a marker's width and a half of another.
  void mark_crowded() {
    places_.clear();
    double widest = 0;
    for (const Target& target : targets_) {
      places_.push_back(target.filter.position());
      widest = std::max(widest, target.width);
    }
    const auto crowd = [&](int a, int b) {
      if (a == b || (places_[a] - places_[b]).norm() > kCrowded * 0.5 * (targets_[a].width + targets_[b].width)) return;
      targets_[a].crowded = targets_[b].crowded = true;
    };
    if (targets_.size() <= kFewTargets) {
      for (int a = 0; a < std::ssize(targets_); ++a) {
        for (int b = 0; b < a; ++b) crowd(a, b);
      }
      return;
    }
    grid_.build(places_, kCrowded * widest);
    for (int a = 0; a < std::ssize(targets_); ++a) {
      grid_.for_each_near(places_[a], kCrowded * widest, [&](int b) { crowd(a, b); });
    }
  }

  /// Brings targets that are missed and points that nobody claims together: every pair within reach, the nearest sum.
  void find_lost(std::span<const Observation<D>> seen) {
    lost_.clear();
    free_.clear();
    for (int i = 0; i < std::ssize(targets_); ++i) {
      if (targets_[i].observation == kNone && targets_[i].covered_by == kNone && targets_[i].standing == Standing::established)
        lost_.push_back(i);
    }
    for (int i = 0; i < std::ssize(seen); ++i) {
      if (!claimed_[i]) free_.push_back(i);
    }
    unexplained_ += kClutterMemory *
                    (std::max<double>(0, static_cast<double>(free_.size()) - static_cast<double>(lost_.size())) - unexplained_);
    if (!lost_.empty()) {
      adopt_points(seen);
      adopt_newcomers();
    }
  }

  /// How far a target's own motion leaves it from a place; where it turned or stopped unseen, its last place tells better.
  double way_to(const Target& target, const Vector<D>& place) const {
    return std::min((place - target.filter.position()).norm(), (place - target.last_place).norm());
  }

  void adopt_points(std::span<const Observation<D>> seen) {
    if (free_.empty() || std::ssize(lost_) * std::ssize(free_) > kMostLostPairs) return;
    pairs_.clear();
    for (int row = 0; row < std::ssize(lost_); ++row) {
      const Target& target = targets_[lost_[row]];
      for (int column = 0; column < std::ssize(free_); ++column) {
        const Vector<D>& place = seen[free_[column]].value;
        const double reach = options_.max_speed * target.unseen + target.width;
        if ((place - target.last_place).norm() > reach || !alike(target, seen[free_[column]])) continue;
        const double way = way_to(target, place);
        if (expected_clutter(way + target.width) > kClutterLimit) continue;
        pairs_.push_back({row, column, 2 * kFar - std::min(way, kFar)});
      }
    }
    const auto columns = assigner_.assign(static_cast<int>(lost_.size()), static_cast<int>(free_.size()), pairs_);
    for (int row = 0; row < std::ssize(lost_); ++row) {
      if (columns[row] == GatedAssigner::nobody) continue;
      const int index = free_[columns[row]];
      begin_anew(targets_[lost_[row]], seen[index]);
      targets_[lost_[row]].observation = index;
      claimed_[index] = 1;
    }
  }

  /// False points to be expected in one frame within `radius` of a place.
  double expected_clutter(double radius) const {
    const double share = std::pow(radius, D) / std::max(std::pow(radius, D), std::pow(extent_, D));
    return unexplained_ * share;
  }

  /// The motion before the jump tells little of the motion after it; half of the velocity seen since is kept for the start.
  void begin_anew(Target& target, const Observation<D>& point) {
    const double jump = (point.value - target.filter.position()).norm();
    if (target.filter.gate_distance(point.value, noise_of(point)) <= kGentleJump || jump < target.width) return;
    F fresh(filter_options_, target.last_place, noise_of(point));
    fresh.predict(target.unseen);
    if (fresh.gate_distance(point.value, noise_of(point)) > 1) fresh = F(filter_options_, point.value, noise_of(point));
    target.filter = fresh;
  }

  /// A newcomer that has stayed is one of those who are missed.
  void adopt_newcomers() {
    pairs_.clear();
    proven_.clear();
    for (int i = 0; i < std::ssize(targets_); ++i) {
      const Target& newcomer = targets_[i];
      if (!newcomer.on_roster() && newcomer.observation != kNone && newcomer.score >= options_.confirm) proven_.push_back(i);
    }
    for (int row = 0; row < std::ssize(lost_); ++row) {
      const Target& target = targets_[lost_[row]];
      if (target.observation != kNone) continue;
      for (const int column : proven_) {
        const Target& newcomer = targets_[column];
        if ((newcomer.last_place - target.last_place).norm() > options_.max_speed * target.unseen) continue;
        pairs_.push_back({row, column, 2 * kFar - std::min(way_to(target, newcomer.last_place), kFar)});
      }
    }
    if (pairs_.empty()) return;
    const auto columns = assigner_.assign(static_cast<int>(lost_.size()), static_cast<int>(targets_.size()), pairs_);
    for (int row = 0; row < std::ssize(lost_); ++row) {
      if (columns[row] == GatedAssigner::nobody) continue;
      Target& target = targets_[lost_[row]];
      Target& newcomer = targets_[columns[row]];
      target.filter = newcomer.filter;
      target.observation = newcomer.observation;
      newcomer.observation = kNone;
    }
  }

  void correct(std::span<const Observation<D>> seen) {
    for (Target& target : targets_) {
      if (target.observation == kNone) continue;
      const Observation<D>& point = seen[target.observation];
      Matrix<D> R = noise_of(point, target);
      if (target.crowded) R.diagonal().array() += square(kCrowdNoise * target.width);
      if (target.standing != Standing::established) target.score += log_ratio(target, point.value, R);
      target.filter.correct(point.value, R);
      if (!target.crowded) target.width += kWidthMemory * (width_of(point) - target.width);
      target.last_place = point.value;
      target.unseen = 0;
      extent_ = std::max(extent_, point.value.cwiseAbs().maxCoeff());
    }
    for (Target& target : targets_) {
      if (target.covered_by == kNone) continue;
      target.last_place = target.filter.position();  // it is seen, though not apart
      target.unseen = std::min(target.unseen, kCoast / 2);
    }
  }

  /// How much likelier the point is the target's than a false one, as a logarithm.
  double log_ratio(const Target& target, const Vector<D>& place, const Matrix<D>& R) const {
    const Matrix<D> S = target.filter.innovation_covariance(R);
    const Vector<D> residual = place - target.filter.position();
    const double clutter_density = std::max(unexplained_, kLeastClutter) / std::pow(extent_, D);
    return -0.5 * (residual.dot(S.inverse() * residual) + std::log(S.determinant()) + D * std::log(2 * std::numbers::pi)) -
           std::log(clutter_density);
  }

  /// A newcomer that misses a frame was a false point; so was a provisional target that misses several.
  void judge_newcomers() {
    const bool all_there = std::none_of(targets_.begin(), targets_.end(), [](const Target& target) {
      return target.standing == Standing::established && target.unseen > 0;
    });
    for (Target& target : targets_) {
      if (target.standing == Standing::established) continue;
      if (target.observation == kNone && target.covered_by == kNone) target.score -= kMissPenalty;
      const bool proven = target.score >= options_.confirm;
      if (proven && (target.standing == Standing::provisional || all_there)) target.standing = Standing::established;
    }
    std::erase_if(targets_, [](const Target& target) {
      const bool missed = target.observation == kNone && target.covered_by == kNone;
      return (target.standing == Standing::newcomer && missed) ||
             (target.standing == Standing::provisional && target.score < -3 * kMissPenalty);
    });
  }

  void start_unclaimed(std::span<const Observation<D>> seen) {
    for (int i = 0; i < std::ssize(seen); ++i) {
      if (!claimed_[i] && static_cast<int>(targets_.size()) < kMostTargets) start(seen[i], i, Standing::newcomer);
    }
  }

  std::span<const Track<D>> report() {
    tracks_.clear();
    for (const Target& target : targets_) {
      tracks_.push_back(
          track_of(target, target.filter, target.observation != kNone ? Track<D>::State::observed : Track<D>::State::predicted));
    }
    return tracks_;
  }

  static Track<D> track_of(const Target& target, const F& filter, typename Track<D>::State state) {
    Track<D> track;
    track.id = target.id;
    track.label = target.label;
    track.position = filter.position();
    track.velocity = filter.velocity();
    track.covariance = filter.covariance();
    track.state = state;
    if (state == Track<D>::State::observed) track.observation = target.observation;
    track.confirmed = target.on_roster();
    if constexpr (D == 2) track.box = Box::from_centre(track.position, target.width, target.width);
    return track;
  }

  static double square(double value) { return value * value; }

  static constexpr double kCoast = 0.5;           // s that a lost target drifts on
  static constexpr double kRoom = 24;             // twice the log-likelihood that a pair may cost
  static constexpr double kWidestGate = 5;        // standard deviations
  static constexpr double kCrowded = 1.4;         // marker widths between two that disturb each other's centres
  static constexpr double kCrowdNoise = 0.25;     // marker widths by which they do
  static constexpr double kGentleJump = 1;        // gates
  static constexpr double kClutterMemory = 0.1;   // a frame
  static constexpr double kClutterLimit = 0.02;   // false points to be expected where a jump is still believed at once
  static constexpr double kLeastClutter = 0.01;   // false points a frame that are always thought possible
  static constexpr double kMissPenalty = 3;       // log of 1 over the chance that a marker is missed
  static constexpr double kWidthNoise = 0.2;      // of the width: what the pixels' raster makes of it
  static constexpr double kMostGrowth = 2.5;      // a lost marker comes back no larger, no smaller than by this
  static constexpr double kWidthMemory = 0.1;     // a frame
  static constexpr double kFar = 1e6;             // px
  static constexpr std::size_t kFewPairs = 4096;  // below this, every pair is looked at
  static constexpr std::size_t kFewTargets = 64;
  static constexpr long kMostLostPairs = 1'000'000;  // glare: nobody is looked for in it
  static constexpr int kMostTargets = 20'000;

  RosterTrackerOptions options_;
  typename F::Options filter_options_;
  std::optional<Timestamp> now_;
  double dt_ = 0;
  int next_id_ = 1;
  double unexplained_ = 0;       // points a frame that nobody explains, a running mean
  double extent_ = 1;            // of the scene, px
  std::vector<Target> targets_;  // in the order of their ids
  std::vector<Track<D>> tracks_;
  // What a frame needs, kept so that it is allocated once.
  std::vector<Vector<D>> points_, places_;
  std::vector<GatedPair> pairs_;
  std::vector<char> claimed_;
  std::vector<int> lost_, free_, proven_;
  PointGrid<D> grid_;
  GatedAssigner assigner_;
};

}  // namespace

template <int D>
std::unique_ptr<Tracker<D>> make_roster_tracker(const RosterTrackerOptions& options) {
  return with_filter<D>(options.filter, [&]<typename F>(const typename F::Options& filter) -> std::unique_ptr<Tracker<D>> {
    return std::make_unique<RosterTracker<F>>(options, filter);
  });
}

template std::unique_ptr<Tracker<2>> make_roster_tracker<2>(const RosterTrackerOptions& options);
template std::unique_ptr<Tracker<3>> make_roster_tracker<3>(const RosterTrackerOptions& options);

}  // namespace marey
