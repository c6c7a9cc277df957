// The tracker of markers: a fixed cast of points that look alike, so that only motion tells them apart.
//
// Each frame: (1) predict; (2) match: the assignment that is globally the likeliest, of points within the search areas; (3) meet: a
// target without a point whose place is covered by another's point is taken to be behind it; while two are that close neither's
// velocity is believed to the point they share, so that each comes out with the motion it went in with; (4) find: targets that are
// missed and points that match none are brought together within the reach of the greatest speed, at once where false
// points are rare, else once the point has proved to stay; (5) correct; (6) start newcomers from what is left.
// That no target on the roster dies is what carries a name across a barrier of any width, and through a turn too sharp for a
// filter. Cost: near linear in targets + points while search areas hold few points; the search for the lost is lost × untaken.
#include "marey/track/roster_tracker.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>

#include <Eigen/LU>

#include "marey/assign/gated_assignment.h"
#include "marey/assign/point_grid.h"
#include "marey/core/error.h"
#include "marey/track/check_frame.h"
#include "marey/track/immediate_tracker.h"
#include "marey/track/roster_adoption.h"
#include "marey/track/roster_rigid_neighbours.h"
#include "marey/track/roster_target.h"

namespace marey::track {
namespace {

template <int D>
class RosterTracker final : public ImmediateTracker<D> {
 public:
  explicit RosterTracker(const RosterTrackerOptions& options)
      : options_(options), likelihood_(options), adoption_(options), neighbours_(options) {
    std::set<std::string> seen;
    for (const std::string& label : options.labels) {
      if (!seen.insert(label).second) throw Error("the label \"{}\" occurs twice; every marker needs a name of its own", label);
    }
  }

  using ImmediateTracker<D>::step;

  std::span<const Track<D>> step(Timestamp now, std::span<const CameraObservations<D>> views) override {
    assert(views.size() == 1 && "cameras are joined before");
    const std::span<const Observation<D>> seen = views.front().seen;
    predict_to(now);
    if (targets_.empty()) {
      start_roster(seen);
    } else {
      taken_.assign(seen.size(), 0);
      if (neighbours_.used()) {
        match(seen, [&](const Target& target) { return target.unseen < 1.5 * dt_; });
        neighbours_.check_followed(targets_, seen, taken_);
        match(seen, [&](const Target& target) { return !target.observation; });
      } else {
        match(seen, [](const Target&) { return true; });
        if (undo_doubted()) match(seen, [](const Target& target) { return !target.observation; });
      }
      meet(seen);
      adoption_.find_lost(targets_, seen, taken_, likelihood_, neighbours_.all());
      forget_parts();
      correct(seen);
      judge_newcomers();
      start_unmatched(seen);
    }
    neighbours_.learn(targets_);
    return report();
  }

  std::span<const Track<D>> expected(Timestamp now) override {
    const double dt = this->seconds_to(now);
    tracks_.clear();
    for (const Target& target : targets_) {
      filter::AnyFilter<D> ahead = target.filter;
      ahead.predict(dt);
      tracks_.push_back(track_of(target, ahead, Track<D>::State::predicted));
    }
    return tracks_;
  }

 private:
  using Target = RosterTarget<D>;
  using Standing = typename Target::Standing;
  using ImmediateTracker<D>::now_;
  using ImmediateTracker<D>::tracks_;

  void predict_to(Timestamp now) {
    check_time(now, now_);
    dt_ = this->seconds_to(now);
    now_ = now;
    for (Target& target : targets_) {
      // A lost target goes on as it went; where that leads out of the picture it is waited for.
      if (target.unseen == 0) {
        target.filter.predict(dt_);
      } else if (coasts(target)) {
        target.filter.predict_unseen(dt_);
      }
      for (auto& doubt : target.doubt) {
        doubt.filter.predict_unseen(dt_);
        doubt.unseen += dt_;
      }
      target.unseen += dt_;
      target.observation.reset();
      target.covered_by.reset();
      target.crowded = false;
    }
  }

  /// Targets that took a doubtful point and are missed right afterwards are what they were before. Whether there are any.
  bool undo_doubted() {
    bool any = false;
    for (Target& target : targets_) {
      if (target.doubt.empty() || target.observation) continue;
      auto& before = target.doubt.front();
      target.filter = std::move(before.filter);
      target.last_place = before.last_place;
      target.unseen = before.unseen;
      if (!target.measured.empty()) target.measured.pop_back();
      target.doubt.clear();
      any = true;
    }
    return any;
  }

  /// Keeps what the target was before it takes a point, as long as that may as well be clutter.
  void doubt(Target& target, const Vector<D>& place, const Matrix<D>& R) {
    if (!likelihood_.cluttered() || !target.on_roster()) return;
    const double worth = likelihood_.log_return(target.filter.log_likelihood(place, R));
    if (!target.doubt.empty()) {
      target.doubt.front().score += worth;
      if (target.doubt.front().score > kBelieved) target.doubt.clear();
    } else if (worth < kDoubted) {
      target.doubt.push_back({target.filter, target.last_place, target.unseen, worth});
    }
  }

  bool coasts(const Target& target) const {
    if (target.predicted_variance > 0) return true;
    if constexpr (D == 2) {
      const Vector<2>& place = target.filter.position();
      const auto& picture = options_.picture;
      if (picture) {
        return place.x() > picture->left && place.x() < picture->right() && place.y() > picture->top &&
               place.y() < picture->bottom();
      }
      return target.unseen < kLongCoast;
    }
    return target.unseen < kCoast;
  }

  /// A target that vanished behind an edge was seen in part before: its filter is begun again from what was seen of it whole.
  void forget_parts() {
    for (Target& target : targets_) {
      auto& measured = target.measured;
      if (!target.missed() || target.unseen > 1.5 * dt_ || measured.empty() || measured.back().whole) continue;
      double unseen = dt_;
      int more = kUnnoticed;
      while (measured.size() > kFewestKept && (!measured.back().whole || more-- > 0)) {
        unseen += measured.back().dt;
        measured.pop_back();
      }
      const std::size_t first = measured.size() > Target::kKept ? measured.size() - Target::kKept : 0;
      filter::AnyFilter<D> fresh(options_.filter, measured[first].place, measured[first].covariance);
      for (std::size_t i = first + 1; i < measured.size(); ++i) {
        fresh.predict(measured[i].dt);
        fresh.correct(measured[i].place, measured[i].covariance);
      }
      fresh.predict(dt_);
      fresh.predict_unseen(unseen - dt_);
      target.filter = std::move(fresh);
    }
  }

  static void remember(Target& target, const Vector<D>& place, const Matrix<D>& R, bool whole) {
    auto& measured = target.measured;
    if (measured.size() >= 2 * Target::kKept) {
      measured.erase(measured.begin(), measured.begin() + static_cast<std::ptrdiff_t>(measured.size() - Target::kKept));
    }
    if (target.unseen > kLongGap) measured.clear();
    measured.push_back({place, R, target.unseen, whole});
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
    if (D == 2) likelihood_.widen_scene(observation.value);
    targets_.push_back({.id = TrackId{next_id_++},
                        .label = {},
                        .filter = {options_.filter, observation.value, likelihood_.noise_of(observation)},
                        .width = likelihood_.width_of(observation),
                        .last_place = observation.value,
                        .observation = index,
                        .standing = standing});
  }

  /// Gives the points that are not taken to those of the targets that are `wanted`.
  template <typename Wanted>
  void match(std::span<const Observation<D>> seen, Wanted&& wanted) {
    points_.clear();
    for (const Observation<D>& point : seen) points_.push_back(point.value);
    const bool few = targets_.size() * seen.size() <= kFewPairs;
    if (!few) grid_.build(points_, 2 * options_.marker_width);
    pairs_.clear();
    const Spread spread = spread_of(seen);
    for (int row = 0; row < std::ssize(targets_); ++row) {
      if (!wanted(targets_[row])) continue;
      const double reach = reach_of(targets_[row], spread);
      const auto consider = [&](int column) {
        if ((points_[column] - targets_[row].filter.position()).squaredNorm() > reach * reach) return;
        if (taken_[column]) return;
        const double worth = gain(targets_[row], seen[column]);
        if (worth > 0 && neighbours_.agree(targets_[row], points_[column], dt_)) pairs_.push_back({row, column, worth});
      };
      if (few) {
        for (int column = 0; column < std::ssize(seen); ++column) consider(column);
      } else {
        grid_.for_each_near(targets_[row].filter.position(), search_radius(targets_[row]), consider);
      }
    }
    const auto columns = assigner_.assign(static_cast<int>(targets_.size()), static_cast<int>(seen.size()), pairs_);
    for (int row = 0; row < std::ssize(targets_); ++row) {
      if (columns[row] == assign::kNoIndex) continue;
      targets_[row].observation = columns[row];
      taken_[columns[row]] = 1;
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
      const double width = likelihood_.width_of(point);
      spread.variance = std::max(spread.variance, likelihood_.noise_of(point).trace());
      spread.narrowest = &point == seen.data() ? width : std::min(spread.narrowest, width);
      spread.widest = std::max(spread.widest, width);
    }
    return spread;
  }

  /// No pair farther apart than this can be worth anything: asked first, because it costs least.
  double reach_of(const Target& target, const Spread& spread) const {
    const double fastest = options_.max_speed * target.unseen + target.width;
    const double change =
        std::max(spread.widest - target.width, target.width - spread.narrowest) - RosterLikelihood<D>::kWidthNoise * target.width;
    return std::min(fastest, target.filter.search_reach(spread.variance + square(std::max(0.0, change))));
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
    const Matrix<D> R = likelihood_.noise_of(point, target);
    if (target.filter.gate_distance(point.value, R) > 1) return 0;
    const double log_likelihood = target.filter.log_likelihood(point.value, R);
    if (target.unseen > 1.5 * dt_) {
      if (!likelihood_.believes_jump(residual.norm() + target.width)) return 0;
      if (likelihood_.cluttered() && likelihood_.log_return(log_likelihood) < kReturns) return 0;
    }
    if (likelihood_.cluttered()) {  // against a false point here and, where the target is known to be there, none of its own
      return 2 * (likelihood_.log_return(log_likelihood) + (target.standing == Standing::established ? kHardlyMissed : 0));
    }
    const double cost = -2 * log_likelihood - D * kLogTwoPi - std::log(square(reference_variance()));
    return std::max(1e-3, kRoom - cost) + (target.on_roster() ? kRoom : 0);
  }

  double reference_variance() const { return square(options_.marker_width); }

  void meet(std::span<const Observation<D>> seen) {
    mark_crowded();
    for (Target& target : targets_) {
      if (target.observation || !target.crowded) continue;
      double nearest = target.width;
      for (const Target& other : targets_) {
        if (!other.observation || other.id == target.id) continue;
        const Observation<D>& point = seen[*other.observation];
        const double distance = (point.value - target.filter.position()).norm();
        const double reach = 0.5 * (likelihood_.width_of(point) + target.width);
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

  void correct(std::span<const Observation<D>> seen) {
    for (Target& target : targets_) {
      if (!target.observation) continue;
      const Observation<D>& point = seen[*target.observation];
      Matrix<D> R = likelihood_.noise_of(point, target);
      if (target.crowded) R.diagonal().array() += square(kCrowdNoise * target.width);
      if (target.standing != Standing::established) target.score += likelihood_.log_ratio(target, point.value, R);
      doubt(target, point.value, R);
      target.filter.correct(point.value, R);
      remember(target, point.value, R, likelihood_.shows_whole(target, point));
      if (!target.crowded) target.width += kWidthMemory * (likelihood_.width_of(point) - target.width);
      target.last_place = point.value;
      target.unseen = 0;
      target.seen += dt_;
      likelihood_.widen_scene(point.value);
    }
    for (Target& target : targets_) {
      if (!target.covered_by) continue;
      target.last_place = target.filter.position();  // it is seen, though not apart
      target.unseen = std::min(target.unseen, kCoast / 2);
    }
  }

  /// A newcomer that misses a frame was a false point; so was a provisional target that misses several.
  void judge_newcomers() {
    const bool all_there = std::none_of(targets_.begin(), targets_.end(), [](const Target& target) {
      return target.standing == Standing::established && target.unseen > 0;
    });
    for (Target& target : targets_) {
      if (target.standing == Standing::established) continue;
      if (!target.observation && !target.covered_by) target.score -= kMissPenalty;
      const bool proven = target.score >= options_.confirm;
      const bool stayed = neighbours_.used() && target.seen > kProof;  // and no target that is missed can be it
      if (proven && (target.standing == Standing::provisional || all_there || stayed)) target.standing = Standing::established;
    }
    std::erase_if(targets_, [&](const Target& target) {
      const bool missed = !target.observation && !target.covered_by;
      if (neighbours_.used() && target.label.empty() && target.seen < kProof && target.unseen > kProof) return true;
      return (target.standing == Standing::newcomer && missed) ||
             (target.standing == Standing::provisional && target.score < -3 * kMissPenalty);
    });
  }

  void start_unmatched(std::span<const Observation<D>> seen) {
    for (int i = 0; i < std::ssize(seen); ++i) {
      if (!taken_[i] && static_cast<int>(targets_.size()) < kMostTargets) start(seen[i], i, Standing::newcomer);
    }
  }

  std::span<const Track<D>> report() {
    tracks_.clear();
    for (const Target& target : targets_) {
      tracks_.push_back(
          track_of(target, target.filter, target.observation ? Track<D>::State::observed : Track<D>::State::predicted));
    }
    this->match_by_observation();
    return tracks_;
  }

  static Track<D> track_of(const Target& target, const filter::AnyFilter<D>& filter, typename Track<D>::State state) {
    Track<D> track;
    track.id = target.id;
    track.label = target.label;
    track.position = filter.position();
    track.velocity = filter.velocity();
    track.covariance = filter.covariance();
    track.covariance.diagonal().array() += target.predicted_variance;
    track.state = state;
    if (state == Track<D>::State::observed) track.observation = target.observation;
    track.confirmed = target.on_roster();
    if constexpr (D == 2) track.box = Box::from_centre(track.position, target.width, target.width);
    return track;
  }

  static double square(double value) { return value * value; }

  static constexpr double kCoast = 0.5;          // s that a lost target drifts on in space
  static constexpr double kLongCoast = 3;        // s that it does in an image of unknown size
  static constexpr double kLongGap = 0.2;        // s, before which nothing is remembered
  static constexpr double kReturns = 5;          // log-likelihood ratio against clutter from which a point brings a target back
  static constexpr double kDoubted = 4;          // the same below which what was before is kept
  static constexpr double kBelieved = 8;         // and of all points since, from which it is no more
  static constexpr int kUnnoticed = 2;           // frames in which less is missing than can be told
  static constexpr std::size_t kFewestKept = 3;  // observations
  static constexpr double kLogTwoPi = 1.8378770664093453;
  static constexpr double kProof = 1;          // s: a target seen for less and gone was never there
  static constexpr double kRoom = 24;          // twice the log-likelihood that a pair may cost
  static constexpr double kWidestGate = 5;     // standard deviations
  static constexpr double kCrowded = 1.4;      // marker widths between two that disturb each other's centres
  static constexpr double kCrowdNoise = 0.25;  // marker widths by which they do
  static constexpr double kHardlyMissed =
      14;                                    // the same of one that was just seen: a corner is likelier than that it is hidden now
  static constexpr double kMissPenalty = 3;  // log of 1 over the chance that a marker is missed
  static constexpr double kWidthMemory = 0.1;     // a frame
  static constexpr std::size_t kFewPairs = 4096;  // below this, every pair is weighed
  static constexpr std::size_t kFewTargets = 64;
  static constexpr int kMostTargets = 20'000;

  RosterTrackerOptions options_;
  double dt_ = 0;
  int next_id_ = 1;
  RosterLikelihood<D> likelihood_;
  RosterAdoption<D> adoption_;
  RosterRigidNeighbours<D> neighbours_;
  std::vector<Target> targets_;  // in the order of their ids
  // What a frame needs, kept so that it is allocated once.
  std::vector<Vector<D>> points_, places_;
  std::vector<assign::GatedPair> pairs_;
  std::vector<char> taken_;
  assign::PointGrid<D> grid_;
  assign::GatedAssigner assigner_;
};

}  // namespace

template <int D>
std::unique_ptr<Tracker<D>> make_roster_tracker(const RosterTrackerOptions& options) {
  return std::make_unique<RosterTracker<D>>(options);
}

template std::unique_ptr<Tracker<2>> make_roster_tracker<2>(const RosterTrackerOptions& options);
template std::unique_ptr<Tracker<3>> make_roster_tracker<3>(const RosterTrackerOptions& options);

}  // namespace marey::track
