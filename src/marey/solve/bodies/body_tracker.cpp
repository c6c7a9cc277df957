#include "marey/solve/bodies/body_tracker.h"

#include <algorithm>
#include <cmath>

#include "marey/assign/no_index.h"
#include "marey/core/error.h"
#include "marey/geometry/layout.h"

namespace marey::solve::bodies {
namespace {

constexpr double kGate = 3.5;            // standard deviations
constexpr double kFirstNoise = 0.0005;   // m, before it is learned
constexpr double kFreedoms = 60;         // that its first guess counts for
constexpr double kMaxFreedoms = 30'000;  // older ones are forgotten
constexpr double kFirstRate = 3;         // m/s: of a body that was not seen before
constexpr double kFirstTurningRate = 6;  // rad/s
constexpr int kMaxInspectedFor = 12;     // bodies an instant
constexpr double kMaxHidden = 3;         // s: after that the pose before says nothing

bool in_a_line(std::span<const Vector<3>> locations) {
  return !fit_pose(locations, locations, 1e-4).has_value();
}

}  // namespace

BodyTracker::BodyTracker(std::vector<Body> bodies, const TrackingOptions& options)
    : bodies_(std::move(bodies)),
      options_(options),
      initialise_(
          [this] {
            std::vector<std::vector<Vector<3>>> layouts;
            for (const Body& body : bodies_) {
              auto& layout = layouts.emplace_back();
              for (const BodyMarker& marker : body.markers) layout.push_back(marker.position);
            }
            return layouts;
          }(),
          options.tolerance),
      counts_(bodies_.size()),
      noise_(options.noise.value_or(kFirstNoise)) {
  for (const Body& body : bodies_) {
    Tracked& one = tracked_.emplace_back();
    for (const BodyMarker& marker : body.markers) one.locations.push_back(marker.position);
    if (one.locations.size() < 3)
      throw Error("body \"{}\" has {} markers; to follow it in all six degrees of freedom it takes three", body.label,
                  one.locations.size());
    if (in_a_line(one.locations))
      throw Error("the markers of body \"{}\" lie in a line; move one of them away from it", body.label);
    one.rotations = symmetries(one.locations, options_.tolerance);
    one.evidence.assign(one.rotations.size(), 0);
    one.rotated.assign(one.rotations.size(), 0);
    if (!one.rotations.empty()) one.hidden.emplace(bodies_.size(), options_.angular_acceleration);
    one.point_of.assign(one.locations.size(), assign::kNoIndex);
    one.shortest_edge = 1e9;
    for (std::size_t a = 0; a < one.locations.size(); ++a) {
      one.reach = std::max(one.reach, one.locations[a].norm());
      for (std::size_t b = 0; b < a; ++b)
        one.shortest_edge = std::min(one.shortest_edge, (one.locations[a] - one.locations[b]).norm());
    }
  }
}

std::span<const BodyPose> BodyTracker::step(Timestamp now, std::span<const BodyTrackPoint> points) {
  owner_.assign(points.size(), std::nullopt);
  corrections_.clear();
  predict(now);
  take_labelled(points);
  search_near(points);
  search_everywhere(now, points);
  for (int body = 0; body < std::ssize(tracked_); ++body) {
    Tracked& one = tracked_[static_cast<std::size_t>(body)];
    if (!one.measured) continue;
    const double turn_variance = one.fit->covariance.topLeftCorner<3, 3>().trace() / 3;
    const double position_variance = one.fit->covariance.bottomRightCorner<3, 3>().trace() / 3;
    one.motion->correct(one.fit->world_from_body, turn_variance, position_variance);
    if (one.rotations.empty() || one.labelled) continue;  // labels know
    weigh_rotations(body, now, points);
    evaluate_return(body, now);
  }
  report(now);
  return poses_;
}

void BodyTracker::predict(Timestamp now) {
  const double dt = last_ ? seconds(now - *last_) : 0;
  if (dt > 0) shortest_step_s_ = std::min(shortest_step_s_, dt);
  last_ = now;
  for (Tracked& one : tracked_) {
    if (one.motion && one.present) one.motion->predict(dt, options_.acceleration, options_.angular_acceleration);
    std::fill(one.point_of.begin(), one.point_of.end(), assign::kNoIndex);
    one.fit.reset();
    one.measured = one.labelled = false;
  }
}

double BodyTracker::gate(const Tracked& one, int marker) const {
  const double arm = one.locations[static_cast<std::size_t>(marker)].squaredNorm();
  return options_.tolerance + kGate * std::sqrt(one.motion->location.value + one.motion->turn.value * arm);
}

/// Takes those of the candidates, a point or −1 by marker, that agree with one pose: as long as one is off, the worst is omitted.
bool BodyTracker::measure(int body, std::span<const BodyTrackPoint> points, std::vector<int> candidates) {
  Tracked& one = tracked_[static_cast<std::size_t>(body)];
  for (;;) {
    std::vector<Vector<3>> locations, detected;
    for (std::size_t m = 0; m < candidates.size(); ++m) {
      if (candidates[m] < 0) continue;
      locations.push_back(one.locations[m]);
      detected.push_back(points[static_cast<std::size_t>(candidates[m])].position);
    }
    const auto fit = fit_pose(locations, detected, noise_);
    if (!fit) return false;
    double worst = 0;
    std::size_t worst_marker = 0;
    for (std::size_t m = 0; m < candidates.size(); ++m) {
      if (candidates[m] < 0) continue;
      const double off =
          (fit->world_from_body * one.locations[m] - points[static_cast<std::size_t>(candidates[m])].position).norm();
      if (off > worst) worst = off, worst_marker = m;
    }
    if (worst > options_.tolerance) {
      candidates[worst_marker] = assign::kNoIndex;
      continue;
    }
    for (std::size_t m = 0; m < candidates.size(); ++m) {
      if (one.point_of[m] >= 0) owner_[static_cast<std::size_t>(one.point_of[m])].reset();
    }
    one.point_of = std::move(candidates);
    for (std::size_t m = 0; m < one.point_of.size(); ++m) {
      if (one.point_of[m] >= 0) owner_[static_cast<std::size_t>(one.point_of[m])] = {body, static_cast<int>(m)};
    }
    one.fit = fit;
    one.measured = true;
    return true;
  }
}

void BodyTracker::take_labelled(std::span<const BodyTrackPoint> points) {
  std::vector<std::vector<int>> named(tracked_.size());
  for (int p = 0; p < std::ssize(points); ++p) {
    const auto& marker = points[static_cast<std::size_t>(p)].marker;
    if (!marker) continue;
    auto& candidates = named[static_cast<std::size_t>(marker->first)];
    candidates.resize(tracked_[static_cast<std::size_t>(marker->first)].locations.size(), assign::kNoIndex);
    candidates[static_cast<std::size_t>(marker->second)] = p;
  }
  for (int body = 0; body < std::ssize(tracked_); ++body) {
    Tracked& one = tracked_[static_cast<std::size_t>(body)];
    auto& candidates = named[static_cast<std::size_t>(body)];
    if (candidates.empty() || !measure(body, points, std::move(candidates))) continue;
    one.labelled = true;
    one.back.reset();
    std::fill(one.rotated.begin(), one.rotated.end(), 0.0);
    if (!one.motion || !one.present) one.motion = BodyMotion::at(one.fit->world_from_body, kFirstRate, kFirstTurningRate);
  }
}

void BodyTracker::search_near(std::span<const BodyTrackPoint> points) {
  pairs_.clear();
  int rows = 0;
  std::vector<int> first_row(tracked_.size(), assign::kNoIndex);
  for (int body = 0; body < std::ssize(tracked_); ++body) {
    const Tracked& one = tracked_[static_cast<std::size_t>(body)];
    if (!one.motion || !one.present || one.measured) continue;
    const double widest = gate(one, 0) + kGate * std::sqrt(one.motion->turn.value) * one.reach;
    // A point that may be anywhere within half an edge is not assigned by place alone.
    if (widest > std::max(one.shortest_edge / 2, 2 * options_.tolerance)) continue;
    first_row[static_cast<std::size_t>(body)] = rows;
    rows += static_cast<int>(one.locations.size());
    const double reach = one.reach + widest;
    for (int p = 0; p < std::ssize(points); ++p) {
      const Vector<3>& point = points[static_cast<std::size_t>(p)].position;
      if (owner_[static_cast<std::size_t>(p)] || (point - one.motion->world_from_body.translation).squaredNorm() > reach * reach)
        continue;
      for (int m = 0; m < std::ssize(one.locations); ++m) {
        const double width = gate(one, m);
        const double square = (one.motion->world_from_body * one.locations[static_cast<std::size_t>(m)] - point).squaredNorm();
        if (square < width * width)
          pairs_.push_back({first_row[static_cast<std::size_t>(body)] + m, p, 2 - square / (width * width)});
      }
    }
  }
  const std::span<const int> column = assigner_.assign(rows, static_cast<int>(points.size()), pairs_);
  for (int body = 0; body < std::ssize(tracked_); ++body) {
    if (first_row[static_cast<std::size_t>(body)] < 0) continue;
    Tracked& one = tracked_[static_cast<std::size_t>(body)];
    for (std::size_t m = 0; m < one.locations.size(); ++m)
      one.point_of[m] = column[static_cast<std::size_t>(first_row[static_cast<std::size_t>(body)]) + m];
  }
  for (int body = 0; body < std::ssize(tracked_); ++body) {
    if (first_row[static_cast<std::size_t>(body)] >= 0) settle_near(body, points);
  }
}

/// A body whose markers have points by prediction: all that agree with one pose, and others that do where it turned out to be; or
/// the prediction, corrected by what there is.
void BodyTracker::settle_near(int body, std::span<const BodyTrackPoint> points) {
  Tracked& one = tracked_[static_cast<std::size_t>(body)];
  std::vector<int> candidates = std::exchange(one.point_of, std::vector<int>(one.locations.size(), assign::kNoIndex));
  for (int& point : candidates) {
    if (point >= 0 && owner_[static_cast<std::size_t>(point)]) point = assign::kNoIndex;
  }
  if (measure(body, points, candidates)) {
    std::vector<int> more = one.point_of;
    bool any = false;
    for (std::size_t m = 0; m < more.size(); ++m) {
      if (more[m] >= 0) continue;
      const Vector<3> location = one.fit->world_from_body * one.locations[m];
      double nearest = options_.tolerance * options_.tolerance;
      for (int p = 0; p < std::ssize(points); ++p) {
        const double square = (points[static_cast<std::size_t>(p)].position - location).squaredNorm();
        if (!owner_[static_cast<std::size_t>(p)] && square < nearest) nearest = square, more[m] = p, any = true;
      }
    }
    if (any) measure(body, points, std::move(more));
    return;
  }
  std::vector<Vector<3>> locations, detected;
  for (std::size_t m = 0; m < candidates.size(); ++m) {
    if (candidates[m] < 0) continue;
    const Vector<3>& location = one.locations[m];
    const Vector<3>& point = points[static_cast<std::size_t>(candidates[m])].position;
    for (std::size_t i = 0; i < locations.size(); ++i) {
      // Which of them is right cannot be decided.
      if (std::abs((locations[i] - location).norm() - (detected[i] - point).norm()) > 2 * options_.tolerance) {
        std::fill(one.point_of.begin(), one.point_of.end(), assign::kNoIndex);
        return;
      }
    }
    locations.push_back(location);
    detected.push_back(point);
    one.point_of[m] = candidates[m];
  }
  if (locations.empty()) return;
  for (std::size_t m = 0; m < candidates.size(); ++m) {
    if (one.point_of[m] >= 0) owner_[static_cast<std::size_t>(one.point_of[m])] = {body, static_cast<int>(m)};
  }
  BodyMotion& motion = *one.motion;
  one.fit = correct_pose({motion.world_from_body, motion.turn.value, motion.location.value}, locations, detected, noise_);
  const auto worst = [&](int block) { return one.fit->covariance.diagonal().segment<3>(block).maxCoeff(); };
  // The rates follow as far as the variances fell; the turn about the line of the markers stays as unknown as it was.
  const auto fallen = [](double before, double after) { return std::max(after * before / std::max(before - after, 1e-30), 1e-12); };
  motion.correct(one.fit->world_from_body, fallen(motion.turn.value, std::min(worst(0), 0.999 * motion.turn.value)),
                 fallen(motion.location.value, std::min(worst(3), 0.999 * motion.location.value)));
  motion.world_from_body = one.fit->world_from_body;
}

void BodyTracker::search_everywhere(Timestamp now, std::span<const BodyTrackPoint> points) {
  std::vector<int> required, names;
  for (int i = 0; i < std::ssize(tracked_) && std::ssize(required) < kMaxInspectedFor; ++i) {
    const int body = (next_initialise_ + i) % static_cast<int>(tracked_.size());
    if (!tracked_[static_cast<std::size_t>(body)].measured) required.push_back(body);
  }
  if (required.empty()) return;
  next_initialise_ = (required.back() + 1) % static_cast<int>(tracked_.size());
  std::vector<Vector<3>> free;
  for (int p = 0; p < std::ssize(points); ++p) {
    const auto& owner = owner_[static_cast<std::size_t>(p)];
    if (owner && tracked_[static_cast<std::size_t>(owner->first)].measured) continue;
    free.push_back(points[static_cast<std::size_t>(p)].position);
    names.push_back(p);
  }
  struct Choice {
    const PoseCandidate* candidate;
    double fraction, distance;
  };
  std::vector<Choice> choices;
  for (const PoseCandidate& candidate : initialise_.find(free, required)) {
    const Tracked& one = tracked_[static_cast<std::size_t>(candidate.body)];
    if (candidate.by_chance > options_.by_chance) continue;
    double distance = 1e3;  // where it was never seen, others come first
    if (one.motion) {
      const double hidden = seconds(now - one.observed_at);
      const Rigid3& from = one.present ? one.motion->world_from_body : one.observed_pose;
      distance = (candidate.world_from_body.translation - from.translation).norm();
      if (hidden < kMaxHidden && distance > 0.05 + options_.fastest * hidden) continue;
    }
    choices.push_back({&candidate, static_cast<double>(candidate.matched) / static_cast<double>(one.locations.size()), distance});
  }
  std::stable_sort(choices.begin(), choices.end(), [](const Choice& a, const Choice& b) {
    return a.fraction != b.fraction ? a.fraction > b.fraction : a.distance < b.distance;
  });
  for (const Choice& choice : choices) {
    if (!tracked_[static_cast<std::size_t>(choice.candidate->body)].measured)
      accept(choice.candidate->body, points, *choice.candidate, names);
  }
}

void BodyTracker::accept(int body, std::span<const BodyTrackPoint> points, const PoseCandidate& candidate,
                         std::span<const int> names) {
  Tracked& one = tracked_[static_cast<std::size_t>(body)];
  std::vector<int> candidates(one.locations.size(), assign::kNoIndex);
  for (std::size_t m = 0; m < candidates.size(); ++m) {
    if (!candidate.point_of[m]) continue;
    candidates[m] = names[static_cast<std::size_t>(*candidate.point_of[m])];
    const auto& owner = owner_[static_cast<std::size_t>(candidates[m])];
    if (owner && owner->first != body && tracked_[static_cast<std::size_t>(owner->first)].measured) return;
  }
  const bool symmetric = one.motion && !one.rotations.empty();
  const bool comes_back = symmetric && seconds(*last_ - one.observed_at) > 2.5 * shortest_step_s_;
  if (symmetric) {
    const Rigid3 nearest =
        nearest_turn(one, candidate.world_from_body, comes_back ? due(body) : one.motion->world_from_body.rotation);
    std::vector<int> rotated(candidates.size(), assign::kNoIndex);
    for (std::size_t m = 0; m < candidates.size(); ++m) {  // which point is where marker m is then
      double minimum = 2 * options_.tolerance;
      for (const int point : candidates) {
        if (point < 0) continue;
        const double off = (nearest * one.locations[m] - points[static_cast<std::size_t>(point)].position).norm();
        if (off < minimum) minimum = off, rotated[m] = point;
      }
    }
    candidates = std::move(rotated);
  }
  for (std::size_t m = 0; m < candidates.size(); ++m) {
    if (one.point_of[m] >= 0) owner_[static_cast<std::size_t>(one.point_of[m])].reset();
    one.point_of[m] = assign::kNoIndex;
  }
  for (const int point : candidates) {
    if (point < 0 || !owner_[static_cast<std::size_t>(point)]) continue;
    Tracked& other = tracked_[static_cast<std::size_t>(owner_[static_cast<std::size_t>(point)]->first)];
    std::replace(other.point_of.begin(), other.point_of.end(), point, assign::kNoIndex);  // it was only predicted there
    owner_[static_cast<std::size_t>(point)].reset();
  }
  if (!measure(body, points, std::move(candidates))) return;
  if (comes_back) {
    one.back = Return{.before = last_sure(one), .after = observed_rotation(body, *last_), .detected = 0};
    one.hidden->interrupt();
  }
  if (!one.motion || !one.present || comes_back)
    one.motion = BodyMotion::at(one.fit->world_from_body, kFirstRate, kFirstTurningRate);
}

void BodyTracker::learn_noise(const PoseFit& fit, std::size_t markers) {
  if (options_.noise || markers < 3) return;
  if (freedoms_ == 0) freedoms_ = kFreedoms, squares_ = kFreedoms * kFirstNoise * kFirstNoise;
  squares_ += fit.sum_of_squares;
  freedoms_ += static_cast<double>(3 * markers - 6);
  if (freedoms_ > kMaxFreedoms) squares_ /= 2, freedoms_ /= 2;
  noise_ = std::clamp(std::sqrt(squares_ / freedoms_), 1e-6, options_.tolerance);
}

void BodyTracker::report(Timestamp now) {
  poses_.clear();
  for (std::size_t b = 0; b < tracked_.size(); ++b) {
    Tracked& one = tracked_[b];
    TrackCounts& counts = counts_[b];
    if (one.measured) {
      const auto detected = std::count_if(one.point_of.begin(), one.point_of.end(), [](int point) { return point >= 0; });
      learn_noise(*one.fit, static_cast<std::size_t>(detected));
      one.present = true;
      one.observed_at = now;
      one.observed_pose = one.fit->world_from_body;
      if (one.hidden) {
        one.observed = observed_rotation(static_cast<int>(b), now);
        if (!one.back) one.hidden->add(one.observed);
      }
      ++counts.measured;
      poses_.push_back({.body = bodies_[b].id,
                        .world_from_body = one.fit->world_from_body,
                        .covariance = one.fit->covariance,
                        .residual_m = one.fit->mean_error,
                        .tracked = true,
                        .other = other_of(one, one.fit->world_from_body)});
      continue;
    }
    if (!one.present || seconds(now - one.observed_at) > options_.predict_s) {
      counts.lost += one.present;
      one.present = false;
      ++counts.absent;
      continue;
    }
    ++counts.predicted;
    BodyPose pose{.body = bodies_[b].id,
                  .world_from_body = one.motion->world_from_body,
                  .covariance = Matrix<6>::Zero(),
                  .residual_m = {},
                  .tracked = false};
    pose.covariance->diagonal() << Vector<3>::Constant(one.motion->turn.value), Vector<3>::Constant(one.motion->location.value);
    if (one.fit) pose.covariance = one.fit->covariance, pose.residual_m = one.fit->mean_error;
    pose.other = other_of(one, pose.world_from_body);
    poses_.push_back(pose);
  }
}

}  // namespace marey::solve::bodies
