#include "marey/track/ground/ground_run.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <variant>

#include "marey/track/ground/motion_statistics.h"

namespace marey::track::ground {
namespace {

constexpr double kCalmer = 0.75;                // of the tracker's accelerations, that the smoother takes: it has pushes beside
constexpr double kSlowest = 1, kFastest = 20;   // s in which velocities settle
constexpr double kOfTwo = std::numbers::sqrt2;  // a target that one camera has placed is seen by another: both err
constexpr double kAgreeing = 0.15;              // m, of disagreement that is left: what gnn takes
constexpr double kOften = 0.2;                  // s between instants, likewise
constexpr double kCalm = 0.25;                  // of the tracker's accelerations: walkers; more is learned of them than it knows
constexpr double kPace = 1.5;                   // of people's speed: of those without data yet

/// A quick one, for learning and prediction in the meantime.
GroundTrackerOptions ahead(GroundTrackerOptions options) {
  options.associate = GroundAssociation::gnn;
  return options;
}

/// What the two teams wear, by the observations of people who share their region with no other.
std::optional<GroundTeams> teams_in(const std::deque<GroundInstant>& instants) {
  std::vector<Appearance> colours;
  for (const GroundInstant& instant : instants) {
    for (const std::vector<Observation<2>>& of : instant.detected) {
      for (const Observation<2>& one : of) {
        if (one.appearance && !one.shared) colours.push_back(*one.appearance);
      }
    }
  }
  return GroundTeams::learn(colours);
}

}  // namespace

GroundRun::GroundRun(const GroundTrackerOptions& tracker, const offline::GroundJoinOptions& join, const GroundLearnOptions& learn,
                     std::shared_ptr<const GroundViews> views, OnDecided on_decided)
    : options_(tracker), join_(join), learn_(learn), views_(std::move(views)), on_decided_(std::move(on_decided)) {
  learned_ = !learn.agreement && !learn.walk;
  make_ground_tracker(options_, views_);  // refuses now what it would refuse later
  tracker_ = make_ground_tracker(learned_ ? options_ : ahead(options_), views_);
}

void GroundRun::step(std::int32_t frame, Timestamp now, std::span<const CameraObservations> views) {
  GroundInstant& instant = kept_.emplace_back(frame, now, views);
  if (!learning()) {
    correct(instant);
    run_tracker(instant);
    return;
  }
  tracker_->step(now, instant.cameras);
  kept_observations_ += instant.observations();
  if (kept_observations_ >= learn_.max_observations) learn();
}

offline::GroundRecorder::Joined GroundRun::finish(const offline::InSight& in_sight) {
  if (learning()) learn();
  record(tracker_->decide_all());
  return std::move(recorder_).join(join_, in_sight);
}

void GroundRun::learn() {
  std::vector<GroundInstant> all(std::make_move_iterator(kept_.begin()), std::make_move_iterator(kept_.end()));
  kept_.clear();
  if (learn_.agreement) {
    agreement_ = CameraBias::learn(all, views_->cameras());
    compared_ =
        compare_cameras(all, {}, views_->cameras());  // as they are: the learned fields may hide that a camera is off by metres
  }
  if (const auto lasting = agreement_.disagreement()) options_.disagreement = kOfTwo * *lasting;
  for (GroundInstant& instant : all) {
    correct(instant);
    kept_.push_back(std::move(instant));
  }
  if (learn_.teams) options_.teams = teams_in(kept_);
  join_.teams = options_.teams;
  if (learn_.walk) learn_motion();
  if (learn_.association && is_plain()) options_.associate = GroundAssociation::gnn;
  learned_ = true;
  tracker_ = make_ground_tracker(options_, views_);
  std::deque<GroundInstant> detected = std::exchange(kept_, {});
  for (GroundInstant& instant : detected) {
    kept_.push_back(std::move(instant));
    run_tracker(kept_.back());
  }
}

/// Hypotheses cost ten times as much, and give more only where cameras disagree or people go far between two instants.
bool GroundRun::is_plain() const {
  if (kept_.size() < 2) return true;
  const double between = seconds(kept_.back().time - kept_.front().time) / static_cast<double>(kept_.size() - 1);
  return between <= kOften && (!agreement_.learned() || agreement_.disagreement().value_or(options_.disagreement) <= kAgreeing);
}

/// From a quick tracker's result on the stored instants.
void GroundRun::learn_motion() {
  const auto quick = make_ground_tracker(ahead(options_), views_);
  offline::GroundRecorder recorder;
  for (const GroundInstant& instant : kept_) {
    const auto tracks = quick->step(instant.time, instant.cameras);
    recorder.add(instant.frame, instant.time, tracks, instant.cameras, quick->matches());
  }
  const std::vector<Timestamp> times(recorder.times().begin(), recorder.times().end());
  const std::optional<MotionStatistics> walk = learn_walk(std::move(recorder).tracklets(), times);
  auto* kalman = std::get_if<filter::KalmanOptions>(&options_.filter);
  if (!walk || (kalman != nullptr && walk->acceleration > kCalm * kalman->acceleration_noise)) return;
  if (kalman != nullptr) {
    kalman->acceleration_noise = walk->acceleration;
    kalman->initial_speed = kPace * walk->speed;
  }
  join_.motion.acceleration = kCalmer * walk->acceleration;
  join_.motion.settling = std::clamp(2 * std::pow(walk->speed / join_.motion.acceleration, 2), kSlowest, kFastest);
}

void GroundRun::run_tracker(const GroundInstant& instant) {
  tracker_->step(instant.time, instant.cameras);
  record(tracker_->decided());
}

void GroundRun::record(std::span<const GroundDecision> decisions) {
  for (const GroundDecision& decision : decisions) {
    GroundInstant& instant = kept_.front();
    recorder_.add(instant.frame, decision.now, decision.tracks, instant.cameras, decision.matches);
    if (on_decided_) on_decided_(instant, decision.matches);
    kept_.pop_front();
  }
}

void GroundRun::correct(GroundInstant& instant) const {
  if (!agreement_.learned()) return;
  for (std::vector<Observation<2>>& of : instant.detected) {
    for (Observation<2>& one : of) one = agreement_.corrected(one);
  }
}

}  // namespace marey::track::ground
