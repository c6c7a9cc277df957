// The tracker of markers: a fixed cast of points that appear alike, so that only motion distinguishes them.
//
// Each frame: (1) predict; (2) match: the assignment that is globally the likeliest, of points within the search areas; (3) meet: a
// target without a point whose place is covered by another's point is taken to be behind it; while two are that close neither's
// velocity is trusted to the point they share, so that each comes out with the motion it went in with; (4) find: targets that are
// missed and points that match none are brought together within the reach of the greatest speed, at once where false
// points are rare, else once the point has proved to stay; (5) correct; (6) start newcomers from the rest.
// That no target on the roster dies is what carries a name across a barrier of any width, and through a turn too sharp for a
// filter. Cost: near linear in targets + points while search areas hold few points; the search for the lost is lost × untaken.
#include "marey/track/roster/roster_tracker.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>

#include <Eigen/LU>

#include "marey/core/error.h"
#include "marey/track/check_frame.h"
#include "marey/track/roster/encounters.h"
#include "marey/track/roster/roster_adoption.h"
#include "marey/track/roster/roster_decisions.h"
#include "marey/track/roster/roster_matching.h"
#include "marey/track/roster/roster_rigid_neighbours.h"
#include "marey/track/roster/roster_target.h"

namespace marey::track::roster {
namespace {

template <int D>
class RosterTracker final : public Tracker<D> {
 public:
  explicit RosterTracker(const RosterTrackerOptions& options)
      : options_(options),
        likelihood_(options),
        matching_(options),
        adoption_(options),
        neighbours_(options),
        decisions_(options.decide_after) {
    std::set<std::string> detected;
    for (const std::string& label : options.labels) {
      if (!detected.insert(label).second) throw Error("the label \"{}\" occurs twice; every marker needs a name of its own", label);
    }
  }

  using Tracker<D>::step;

  std::span<const Track<D>> step(Timestamp now, std::span<const CameraObservations<D>> views) override {
    assert(views.size() == 1 && "cameras are joined before");
    const std::span<const Observation<D>> detected = views.front().detected;
    predict_to(now);
    if (targets_.empty()) {
      start_roster(detected);
    } else {
      taken_.assign(detected.size(), 0);
      match(detected, [&](const Target& target) { return !neighbours_.used() || target.unobserved < 1.5 * dt_; });
      if (neighbours_.used()) {
        neighbours_.check_tracked(targets_, detected, taken_, now);
        match(detected, [](const Target& target) { return !target.observation; });
      } else if (undo_uncertain()) {
        match(detected, [](const Target& target) { return !target.observation; });
      }
      close_encounters_.meet(targets_, detected, likelihood_);
      adoption_.find_lost(targets_, detected, taken_, likelihood_, neighbours_);
      forget_parts();
      correct(detected);
      evaluate_newcomers();
      start_unmatched(detected);
    }
    neighbours_.learn(targets_, dt_);
    report();
    if (waits()) {
      decisions_.add(now, tracks_);
      decisions_.rename(neighbours_.renamed(targets_));
    }
    return tracks_;
  }

  std::span<const ObservationMatch> matches() const override { return matches_; }

  std::span<const Decision<D>> decided() override {
    if (waits()) return decisions_.take(false);
    if (!now_) return {};
    decision_ = {*now_, tracks_, matches_};
    return {&decision_, 1};
  }

  std::span<const Decision<D>> decide_all() override { return waits() ? decisions_.take(true) : std::span<const Decision<D>>(); }

  std::span<const Track<D>> expected(Timestamp now) override {
    const double dt = seconds_to(now);
    tracks_.clear();
    for (const Target& target : targets_) {
      filter::AnyFilter<D> ahead = target.filter;
      ahead.predict(dt);
      tracks_.push_back(track_of(target, ahead, Provenance::predicted));
    }
    return tracks_;
  }

 private:
  using Target = RosterTarget<D>;
  using Standing = typename Target::Standing;

  bool waits() const { return neighbours_.used() && options_.decide_after > 0; }

  /// From the last instant to `now`; 0 before the first.
  double seconds_to(Timestamp now) const { return now_ ? seconds(now - *now_) : 0.0; }

  template <typename Wanted>
  void match(std::span<const Observation<D>> detected, Wanted&& required) {
    required_.clear();
    for (const Target& target : targets_) required_.push_back(required(target) ? 1 : 0);
    matching_.match(targets_, required_, detected, taken_, dt_, likelihood_, neighbours_);
  }

  void predict_to(Timestamp now) {
    check_time(now, now_);
    dt_ = seconds_to(now);
    now_ = now;
    const double others = speed_of_observed();
    for (Target& target : targets_) {
      target.travel += std::min(std::max(target.speed, others), options_.max_speed) * dt_;
      if (target.unobserved == 0) {
        target.filter.predict(dt_);
      } else if (coasts(target)) {
        coast(target);
      }
      for (auto& undo : target.undo) {
        undo.filter.predict_unobserved(dt_);
        undo.unobserved += dt_;
      }
      target.unobserved += dt_;
      target.observation.reset();
      target.covered_by.reset();
      target.crowded = false;
    }
  }

  /// The speed that most of the targets that were just seen stay below: one that is hidden moves as they do, if not as it did.
  double speed_of_observed() {
    speeds_.clear();
    for (const Target& target : targets_) {
      if (target.on_roster() && target.unobserved == 0) speeds_.push_back(target.speed);
    }
    if (speeds_.empty()) return 0;
    const auto maximum = speeds_.begin() + static_cast<std::ptrdiff_t>(kMajority * static_cast<double>(speeds_.size() - 1));
    std::nth_element(speeds_.begin(), maximum, speeds_.end());
    return *maximum;
  }

  /// Targets that took a doubtful point and are missed right afterwards are what they were before. Whether there are any.
  bool undo_uncertain() {
    bool any = false;
    for (Target& target : targets_) {
      if (target.undo.empty() || target.observation) continue;
      auto& before = target.undo.front();
      target.filter = std::move(before.filter);
      target.last_position = before.last_position;
      target.unobserved = before.unobserved;
      if (!target.measured.empty()) target.measured.pop_back();
      target.undo.clear();
      any = true;
    }
    return any;
  }

  /// Keeps what the target was before it takes a point, as long as that may as well be clutter.
  void keep_for_undo(Target& target, const Vector<D>& location, const Matrix<D>& R) {
    if (!likelihood_.cluttered() || !target.on_roster()) return;
    const double merit = likelihood_.log_return(target.filter.log_likelihood(location, R));
    if (!target.undo.empty()) {
      target.undo.front().score += merit;
      if (target.undo.front().score > kAccepted) target.undo.clear();
    } else if (merit < kFlagged) {
      target.undo.push_back({target.filter, target.last_position, target.unobserved, merit});
    }
  }

  bool coasts(const Target& target) const {
    if (target.predicted_variance > 0) return true;
    if constexpr (D == 2) return options_.image || target.unobserved < kLongCoast;
    return target.unobserved < kCoast;
  }

  bool in_image(const Vector<D>& location) const {
    if constexpr (D == 3) return true;
    const auto& image = options_.image;
    return !image || (location.x() > image->left && location.x() < image->right() && location.y() > image->top &&
                      location.y() < image->bottom());
  }

  /// A lost target continues as it went, up to the border of the image.
  void coast(Target& target) const {
    if constexpr (D == 3) return target.filter.predict_unobserved(dt_);
    filter::AnyFilter<D> ahead = target.filter;
    ahead.predict_unobserved(dt_);
    if (in_image(ahead.position())) target.filter = std::move(ahead);
  }

  /// Whether its place is known: that of a target that is not seen in an image only while it cannot have gone far.
  bool is_located(const Target& target) const {
    if (D == 3 || !target.missed()) return true;
    return target.travel <= kKnownWithin * target.width && in_image(target.filter.position());
  }

  /// A target that vanished behind an edge was seen in part before: its filter is begun again from the whole observations of it.
  void forget_parts() {
    for (Target& target : targets_) {
      auto& measured = target.measured;
      if (!target.missed() || target.unobserved > 1.5 * dt_ || measured.empty() || measured.back().whole) continue;
      double unobserved = dt_;
      int more = kUnnoticed;
      while (measured.size() > kMinKept && (!measured.back().whole || more-- > 0)) {
        unobserved += measured.back().dt;
        measured.pop_back();
      }
      const std::size_t first = measured.size() > Target::kKept ? measured.size() - Target::kKept : 0;
      filter::AnyFilter<D> fresh(options_.filter, measured[first].location, measured[first].covariance);
      for (std::size_t i = first + 1; i < measured.size(); ++i) {
        fresh.predict(measured[i].dt);
        fresh.correct(measured[i].location, measured[i].covariance);
      }
      fresh.predict(dt_);
      fresh.predict_unobserved(unobserved - dt_);
      target.filter = std::move(fresh);
    }
  }

  static void remember(Target& target, const Vector<D>& location, const Matrix<D>& R, bool whole) {
    auto& measured = target.measured;
    if (measured.size() >= Target::kMaxKept)
      measured.erase(measured.begin(), measured.begin() + static_cast<std::ptrdiff_t>(measured.size() - Target::kMaxKept / 2));
    if (target.unobserved > kLongGap) measured.clear();
    measured.push_back({location, R, target.unobserved, whole});
  }

  void start_roster(std::span<const Observation<D>> detected) {
    if (detected.empty()) return;
    if (detected.size() < options_.labels.size()) {
      throw Error("there are {} labels, but {} markers are seen in the first frame; give as many labels as markers, or fewer",
                  options_.labels.size(), detected.size());
    }
    std::vector<int> order(detected.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](int a, int b) {
      return std::lexicographical_compare(detected[a].value.begin(), detected[a].value.end(), detected[b].value.begin(),
                                          detected[b].value.end());
    });
    for (const int index : order) {
      start(detected[index], index, options_.labels.empty() ? Standing::provisional : Standing::established);
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
                        .typical_variance = likelihood_.variance_of(observation),
                        .last_position = observation.value,
                        .observation = index,
                        .since = *now_,
                        .sure_until = *now_,
                        .may_be_another = standing == Standing::newcomer,
                        .standing = standing});
  }

  void correct(std::span<const Observation<D>> detected) {
    for (Target& target : targets_) {
      if (!target.observation) continue;
      const Observation<D>& point = detected[*target.observation];
      Matrix<D> R = likelihood_.noise_of(point, target);
      if (target.crowded) R.diagonal().array() += square(kCrowdNoise * target.width);
      if (target.standing != Standing::established) target.score += likelihood_.log_ratio(target, point.value, R);
      keep_for_undo(target, point.value, R);
      target.filter.correct(point.value, R);
      remember(target, point.value, R, likelihood_.shows_whole(target, point));
      if (target.unobserved > 1.5 * dt_) target.since = *now_;
      if (!target.crowded) {
        target.width += kWidthMemory * (likelihood_.width_of(point) - target.width);
        target.typical_variance += kVarianceMemory * (likelihood_.variance_of(point) - target.typical_variance);
      }
      target.speed = std::max(target.filter.velocity().norm(), target.speed * std::exp(-dt_ / kSpeedMemory));
      target.last_position = point.value;
      target.unobserved = target.travel = 0;
      target.detected += dt_;
      likelihood_.widen_scene(point.value);
    }
    for (Target& target : targets_) {
      if (!target.covered_by) continue;
      target.last_position = target.filter.position();  // it is seen, though not apart
      target.unobserved = std::min(target.unobserved, kCoast / 2);
      target.travel = std::min(target.travel, target.speed * target.unobserved);
    }
  }

  /// A newcomer that misses a frame was a false point; so was a provisional target that misses several.
  void evaluate_newcomers() {
    const bool all_there = std::none_of(targets_.begin(), targets_.end(), [](const Target& target) {
      return target.standing == Standing::established && target.unobserved > 0;
    });
    for (Target& target : targets_) {
      if (target.standing == Standing::established) continue;
      if (!target.observation && !target.covered_by) target.score -= kMissPenalty;
      const bool proven = target.score >= options_.confirm;
      // No target that is missed can be it: in an image one within whose reach it is was given it before.
      const bool stayed = !neighbours_.used() || target.detected > kProof;
      if (proven && (target.standing == Standing::provisional || all_there || stayed)) {
        if (!target.on_roster()) neighbours_.confirm(target);
        target.standing = Standing::established;
      }
    }
    std::erase_if(targets_, [&](const Target& target) {
      if (!given_up(target)) return false;
      neighbours_.forget(target);
      return true;
    });
  }

  bool given_up(const Target& target) const {
    if (neighbours_.used() && target.label.empty() && target.detected < kProof && target.unobserved > kProof) return true;
    if (neighbours_.used() && target.may_be_another && target.unobserved > kForgotten + kScoreWeight * target.detected) return true;
    const double patience = neighbours_.used() ? kNewcomerGap : 0;
    return (target.standing == Standing::newcomer && target.missed() && target.unobserved > patience) ||
           (target.standing == Standing::provisional && target.score < -3 * kMissPenalty);
  }

  void start_unmatched(std::span<const Observation<D>> detected) {
    for (int i = 0; i < std::ssize(detected); ++i) {
      if (!taken_[i] && static_cast<int>(targets_.size()) < kMaxTargets) start(detected[i], i, Standing::newcomer);
    }
  }

  void report() {
    tracks_.clear();
    matches_.clear();
    for (const Target& target : targets_) {
      tracks_.push_back(track_of(target, target.filter, target.observation ? Provenance::measured : Provenance::predicted));
      if (target.observation) matches_.push_back({target.id, 0, *target.observation});
    }
  }

  Track<D> track_of(const Target& target, const filter::AnyFilter<D>& filter, Provenance provenance) const {
    Track<D> track;
    track.id = target.id;
    track.label = target.label;
    track.position = filter.position();
    track.velocity = filter.velocity();
    track.covariance = filter.covariance();
    track.covariance.diagonal().array() += target.predicted_variance;
    track.provenance = provenance;
    if (provenance == Provenance::measured) track.observation = target.observation;
    track.confirmed = target.on_roster() && is_located(target);
    if constexpr (D == 2) track.box = Box::from_centre(track.position, target.width, target.width);
    return track;
  }

  static double square(double value) { return value * value; }

  static constexpr double kCoast = 0.5;            // s that a lost target drifts on in space
  static constexpr double kLongCoast = 3;          // s that it does in an image of unknown size
  static constexpr double kMajority = 0.75;        // of the targets
  static constexpr double kSpeedMemory = 0.5;      // s
  static constexpr double kKnownWithin = 3;        // marker widths that it may have gone
  static constexpr double kLongGap = 0.2;          // s, before which nothing is remembered
  static constexpr double kFlagged = 4;            // the same below which what was before is kept
  static constexpr double kAccepted = 8;           // and of all points since, from which it is no more
  static constexpr int kUnnoticed = 2;             // frames in which less is missing than can be reported
  static constexpr std::size_t kMinKept = 3;       // observations
  static constexpr double kProof = 0.5;            // s: a target seen for less and gone was never there
  static constexpr double kForgotten = 30;         // s after which one that came later and was barely seen is waited for no more,
  static constexpr double kScoreWeight = 10;       // and this much longer for each second that it was seen
  static constexpr double kNewcomerGap = 0.1;      // s that a newcomer in space may be missed for
  static constexpr double kCrowdNoise = 0.25;      // marker widths by which they do
  static constexpr double kMissPenalty = 3;        // log of 1 over the chance that a marker is missed
  static constexpr double kWidthMemory = 0.1;      // a frame
  static constexpr double kVarianceMemory = 0.02;  // a frame
  static constexpr int kMaxTargets = 20'000;

  RosterTrackerOptions options_;
  std::optional<Timestamp> now_;  // of the last instant
  double dt_ = 0;
  int next_id_ = 1;
  RosterLikelihood<D> likelihood_;
  RosterMatching<D> matching_;
  RosterEncounters<D> close_encounters_;
  RosterAdoption<D> adoption_;
  RosterRigidNeighbours<D> neighbours_;
  RosterDecisions<D> decisions_;
  std::vector<Target> targets_;  // in the order of their ids
  // What a frame needs, kept so that it is allocated once.
  std::vector<Track<D>> tracks_;
  std::vector<ObservationMatch> matches_;
  Decision<D> decision_;
  std::vector<char> taken_, required_;
  std::vector<double> speeds_;
};

}  // namespace

template <int D>
std::unique_ptr<Tracker<D>> make_roster_tracker(const RosterTrackerOptions& options) {
  return std::make_unique<RosterTracker<D>>(options);
}

template std::unique_ptr<Tracker<2>> make_roster_tracker<2>(const RosterTrackerOptions& options);
template std::unique_ptr<Tracker<3>> make_roster_tracker<3>(const RosterTrackerOptions& options);

}  // namespace marey::track::roster
