#include "marey/solve/bodies/body_follower.h"

#include <algorithm>
#include <cmath>

#include "marey/assign/no_index.h"
#include "marey/core/error.h"
#include "marey/geometry/layout.h"

namespace marey::solve::bodies {
namespace {

constexpr double kGate = 3.5;             // standard deviations
constexpr double kFirstNoise = 0.0005;    // m, before it is learned
constexpr double kFreedoms = 60;          // that its first guess counts for
constexpr double kMostFreedoms = 30'000;  // older ones are forgotten
constexpr double kFirstRate = 3;          // m/s: of a body that was not seen before
constexpr double kFirstTurningRate = 6;   // rad/s
constexpr int kMostLookedFor = 12;        // bodies an instant
constexpr double kLongestHidden = 3;      // s: after that the pose before says nothing

bool in_a_line(std::span<const Vector<3>> places) {
  return !fit_pose(places, places, 1e-4).has_value();
}

}  // namespace

BodyFollower::BodyFollower(std::vector<Body> bodies, const FollowOptions& options)
    : bodies_(std::move(bodies)),
      options_(options),
      boot_(
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
    Followed& one = followed_.emplace_back();
    for (const BodyMarker& marker : body.markers) one.places.push_back(marker.position);
    if (one.places.size() < 3)
      throw Error("body \"{}\" has {} markers; to follow it in all six degrees of freedom it takes three", body.label,
                  one.places.size());
    if (in_a_line(one.places)) throw Error("the markers of body \"{}\" lie in a line; move one of them away from it", body.label);
    one.turns = symmetries(one.places, options_.tolerance);
    one.evidence.assign(one.turns.size(), 0);
    one.point_of.assign(one.places.size(), assign::kNoIndex);
    one.shortest_edge = 1e9;
    for (std::size_t a = 0; a < one.places.size(); ++a) {
      one.reach = std::max(one.reach, one.places[a].norm());
      for (std::size_t b = 0; b < a; ++b) one.shortest_edge = std::min(one.shortest_edge, (one.places[a] - one.places[b]).norm());
    }
  }
}

std::span<const BodyPose> BodyFollower::step(Timestamp now, std::span<const FollowedPoint> points) {
  owner_.assign(points.size(), std::nullopt);
  corrections_.clear();
  predict(now);
  take_labelled(points);
  look_near(points);
  look_everywhere(now, points);
  for (int body = 0; body < std::ssize(followed_); ++body) {
    Followed& one = followed_[static_cast<std::size_t>(body)];
    if (!one.measured) continue;
    const double turn_variance = one.fit->covariance.topLeftCorner<3, 3>().trace() / 3;
    const double place_variance = one.fit->covariance.bottomRightCorner<3, 3>().trace() / 3;
    one.motion->correct(one.fit->world_from_body, turn_variance, place_variance);
    if (one.turns.empty() || one.labelled) continue;  // labels know
    weigh_turns(body, now, points);
    judge_return(body, now);
  }
  report(now);
  return poses_;
}

void BodyFollower::predict(Timestamp now) {
  const double dt = last_ ? seconds(now - *last_) : 0;
  last_ = now;
  for (Followed& one : followed_) {
    if (one.motion && one.present) one.motion->predict(dt, options_.acceleration, options_.angular_acceleration);
    std::fill(one.point_of.begin(), one.point_of.end(), assign::kNoIndex);
    one.fit.reset();
    one.measured = one.labelled = false;
  }
}

double BodyFollower::gate(const Followed& one, int marker) const {
  const double arm = one.places[static_cast<std::size_t>(marker)].squaredNorm();
  return options_.tolerance + kGate * std::sqrt(one.motion->place.value + one.motion->turn.value * arm);
}

/// Takes those of the candidates, a point or −1 by marker, that agree with one pose: as long as one is off, the worst is left out.
bool BodyFollower::measure(int body, std::span<const FollowedPoint> points, std::vector<int> candidates) {
  Followed& one = followed_[static_cast<std::size_t>(body)];
  for (;;) {
    std::vector<Vector<3>> places, seen;
    for (std::size_t m = 0; m < candidates.size(); ++m) {
      if (candidates[m] < 0) continue;
      places.push_back(one.places[m]);
      seen.push_back(points[static_cast<std::size_t>(candidates[m])].position);
    }
    const auto fit = fit_pose(places, seen, noise_);
    if (!fit) return false;
    double worst = 0;
    std::size_t worst_marker = 0;
    for (std::size_t m = 0; m < candidates.size(); ++m) {
      if (candidates[m] < 0) continue;
      const double off = (fit->world_from_body * one.places[m] - points[static_cast<std::size_t>(candidates[m])].position).norm();
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

void BodyFollower::take_labelled(std::span<const FollowedPoint> points) {
  std::vector<std::vector<int>> named(followed_.size());
  for (int p = 0; p < std::ssize(points); ++p) {
    const auto& marker = points[static_cast<std::size_t>(p)].marker;
    if (!marker) continue;
    auto& candidates = named[static_cast<std::size_t>(marker->first)];
    candidates.resize(followed_[static_cast<std::size_t>(marker->first)].places.size(), assign::kNoIndex);
    candidates[static_cast<std::size_t>(marker->second)] = p;
  }
  for (int body = 0; body < std::ssize(followed_); ++body) {
    Followed& one = followed_[static_cast<std::size_t>(body)];
    auto& candidates = named[static_cast<std::size_t>(body)];
    if (candidates.empty() || !measure(body, points, std::move(candidates))) continue;
    one.labelled = true;
    one.back.reset();
    if (!one.motion || !one.present) one.motion = BodyMotion::at(one.fit->world_from_body, kFirstRate, kFirstTurningRate);
  }
}

void BodyFollower::look_near(std::span<const FollowedPoint> points) {
  pairs_.clear();
  int rows = 0;
  std::vector<int> first_row(followed_.size(), assign::kNoIndex);
  for (int body = 0; body < std::ssize(followed_); ++body) {
    const Followed& one = followed_[static_cast<std::size_t>(body)];
    if (!one.motion || !one.present || one.measured) continue;
    const double widest = gate(one, 0) + kGate * std::sqrt(one.motion->turn.value) * one.reach;
    // What may be anywhere within half an edge is nobody's by place alone.
    if (widest > std::max(one.shortest_edge / 2, 2 * options_.tolerance)) continue;
    first_row[static_cast<std::size_t>(body)] = rows;
    rows += static_cast<int>(one.places.size());
    const double reach = one.reach + widest;
    for (int p = 0; p < std::ssize(points); ++p) {
      const Vector<3>& point = points[static_cast<std::size_t>(p)].position;
      if (owner_[static_cast<std::size_t>(p)] || (point - one.motion->world_from_body.translation).squaredNorm() > reach * reach)
        continue;
      for (int m = 0; m < std::ssize(one.places); ++m) {
        const double width = gate(one, m);
        const double square = (one.motion->world_from_body * one.places[static_cast<std::size_t>(m)] - point).squaredNorm();
        if (square < width * width)
          pairs_.push_back({first_row[static_cast<std::size_t>(body)] + m, p, 2 - square / (width * width)});
      }
    }
  }
  const std::span<const int> column = assigner_.assign(rows, static_cast<int>(points.size()), pairs_);
  for (int body = 0; body < std::ssize(followed_); ++body) {
    if (first_row[static_cast<std::size_t>(body)] < 0) continue;
    Followed& one = followed_[static_cast<std::size_t>(body)];
    for (std::size_t m = 0; m < one.places.size(); ++m)
      one.point_of[m] = column[static_cast<std::size_t>(first_row[static_cast<std::size_t>(body)]) + m];
  }
  for (int body = 0; body < std::ssize(followed_); ++body) {
    if (first_row[static_cast<std::size_t>(body)] >= 0) settle_near(body, points);
  }
}

/// A body whose markers have points by prediction: all that agree with one pose, and others that do where it turned out to be; or
/// the prediction, corrected by what there is.
void BodyFollower::settle_near(int body, std::span<const FollowedPoint> points) {
  Followed& one = followed_[static_cast<std::size_t>(body)];
  std::vector<int> candidates = std::exchange(one.point_of, std::vector<int>(one.places.size(), assign::kNoIndex));
  for (int& point : candidates) {
    if (point >= 0 && owner_[static_cast<std::size_t>(point)]) point = assign::kNoIndex;
  }
  if (measure(body, points, candidates)) {
    std::vector<int> more = one.point_of;
    bool any = false;
    for (std::size_t m = 0; m < more.size(); ++m) {
      if (more[m] >= 0) continue;
      const Vector<3> place = one.fit->world_from_body * one.places[m];
      double nearest = options_.tolerance * options_.tolerance;
      for (int p = 0; p < std::ssize(points); ++p) {
        const double square = (points[static_cast<std::size_t>(p)].position - place).squaredNorm();
        if (!owner_[static_cast<std::size_t>(p)] && square < nearest) nearest = square, more[m] = p, any = true;
      }
    }
    if (any) measure(body, points, std::move(more));
    return;
  }
  std::vector<Vector<3>> places, seen;
  for (std::size_t m = 0; m < candidates.size(); ++m) {
    if (candidates[m] < 0) continue;
    const Vector<3>& place = one.places[m];
    const Vector<3>& point = points[static_cast<std::size_t>(candidates[m])].position;
    for (std::size_t i = 0; i < places.size(); ++i) {
      // Which of them is right, nobody knows.
      if (std::abs((places[i] - place).norm() - (seen[i] - point).norm()) > 2 * options_.tolerance) {
        std::fill(one.point_of.begin(), one.point_of.end(), assign::kNoIndex);
        return;
      }
    }
    places.push_back(place);
    seen.push_back(point);
    one.point_of[m] = candidates[m];
  }
  if (places.empty()) return;
  for (std::size_t m = 0; m < candidates.size(); ++m) {
    if (one.point_of[m] >= 0) owner_[static_cast<std::size_t>(one.point_of[m])] = {body, static_cast<int>(m)};
  }
  BodyMotion& motion = *one.motion;
  one.fit = correct_pose({motion.world_from_body, motion.turn.value, motion.place.value}, places, seen, noise_);
  const auto worst = [&](int block) { return one.fit->covariance.diagonal().segment<3>(block).maxCoeff(); };
  // The rates follow as far as the variances fell; the turn about the line of the markers stays as unknown as it was.
  const auto fallen = [](double before, double after) { return std::max(after * before / std::max(before - after, 1e-30), 1e-12); };
  motion.correct(one.fit->world_from_body, fallen(motion.turn.value, std::min(worst(0), 0.999 * motion.turn.value)),
                 fallen(motion.place.value, std::min(worst(3), 0.999 * motion.place.value)));
  motion.world_from_body = one.fit->world_from_body;
}

void BodyFollower::look_everywhere(Timestamp now, std::span<const FollowedPoint> points) {
  std::vector<int> wanted, names;
  for (int i = 0; i < std::ssize(followed_) && std::ssize(wanted) < kMostLookedFor; ++i) {
    const int body = (next_boot_ + i) % static_cast<int>(followed_.size());
    if (!followed_[static_cast<std::size_t>(body)].measured) wanted.push_back(body);
  }
  if (wanted.empty()) return;
  next_boot_ = (wanted.back() + 1) % static_cast<int>(followed_.size());
  std::vector<Vector<3>> free;
  for (int p = 0; p < std::ssize(points); ++p) {
    const auto& owner = owner_[static_cast<std::size_t>(p)];
    if (owner && followed_[static_cast<std::size_t>(owner->first)].measured) continue;
    free.push_back(points[static_cast<std::size_t>(p)].position);
    names.push_back(p);
  }
  struct Choice {
    const BootCandidate* candidate;
    double share, distance;
  };
  std::vector<Choice> choices;
  for (const BootCandidate& candidate : boot_.find(free, wanted)) {
    const Followed& one = followed_[static_cast<std::size_t>(candidate.body)];
    if (candidate.by_chance > options_.by_chance) continue;
    double distance = 1e3;  // where it was never seen, others come first
    if (one.motion) {
      const double hidden = seconds(now - one.seen_at);
      const Rigid3& from = one.present ? one.motion->world_from_body : one.seen_pose;
      distance = (candidate.world_from_body.translation - from.translation).norm();
      if (hidden < kLongestHidden && distance > 0.05 + options_.fastest * hidden) continue;
    }
    choices.push_back({&candidate, static_cast<double>(candidate.matched) / static_cast<double>(one.places.size()), distance});
  }
  std::stable_sort(choices.begin(), choices.end(), [](const Choice& a, const Choice& b) {
    return a.share != b.share ? a.share > b.share : a.distance < b.distance;
  });
  for (const Choice& choice : choices) {
    if (!followed_[static_cast<std::size_t>(choice.candidate->body)].measured)
      accept(choice.candidate->body, points, *choice.candidate, names);
  }
}

void BodyFollower::accept(int body, std::span<const FollowedPoint> points, const BootCandidate& candidate,
                          std::span<const int> names) {
  Followed& one = followed_[static_cast<std::size_t>(body)];
  std::vector<int> candidates(one.places.size(), assign::kNoIndex);
  for (std::size_t m = 0; m < candidates.size(); ++m) {
    if (!candidate.point_of[m]) continue;
    candidates[m] = names[static_cast<std::size_t>(*candidate.point_of[m])];
    const auto& owner = owner_[static_cast<std::size_t>(candidates[m])];
    if (owner && owner->first != body && followed_[static_cast<std::size_t>(owner->first)].measured) return;
  }
  const bool known = one.motion && seconds(*last_ - one.seen_at) < kLongestHidden;
  if (known && !one.turns.empty()) {
    if (!one.present) {  // it was given up; how it turned on says where it is due
      one.motion->world_from_body.rotation =
          geometry::rotation_from(seconds(*last_ - one.seen_at) * one.seen_rate) * one.seen_pose.rotation;
    }
    const Rigid3 nearest = nearest_turn(one, candidate.world_from_body);
    std::vector<int> turned(candidates.size(), assign::kNoIndex);
    for (std::size_t m = 0; m < candidates.size(); ++m) {  // which point is where marker m is then
      double least = 2 * options_.tolerance;
      for (const int point : candidates) {
        if (point < 0) continue;
        const double off = (nearest * one.places[m] - points[static_cast<std::size_t>(point)].position).norm();
        if (off < least) least = off, turned[m] = point;
      }
    }
    candidates = std::move(turned);
  }
  for (std::size_t m = 0; m < candidates.size(); ++m) {
    if (one.point_of[m] >= 0) owner_[static_cast<std::size_t>(one.point_of[m])].reset();
    one.point_of[m] = assign::kNoIndex;
  }
  for (const int point : candidates) {
    if (point < 0 || !owner_[static_cast<std::size_t>(point)]) continue;
    Followed& other = followed_[static_cast<std::size_t>(owner_[static_cast<std::size_t>(point)]->first)];
    std::replace(other.point_of.begin(), other.point_of.end(), point, assign::kNoIndex);  // it was only predicted there
    owner_[static_cast<std::size_t>(point)].reset();
  }
  if (!measure(body, points, std::move(candidates))) return;
  if (known && !one.turns.empty())
    one.back = Return{.since = *last_,
                      .lost = one.seen_at,
                      .before = one.seen_pose,
                      .after = one.fit->world_from_body,
                      .rate_before = one.seen_rate,
                      .seen = 0};
  if (!one.motion || !one.present || one.turns.size() > 0)
    one.motion = BodyMotion::at(one.fit->world_from_body, kFirstRate, kFirstTurningRate);
}

void BodyFollower::learn_noise(const PoseFit& fit, std::size_t markers) {
  if (options_.noise || markers < 3) return;
  if (freedoms_ == 0) freedoms_ = kFreedoms, squares_ = kFreedoms * kFirstNoise * kFirstNoise;
  squares_ += fit.sum_of_squares;
  freedoms_ += static_cast<double>(3 * markers - 6);
  if (freedoms_ > kMostFreedoms) squares_ /= 2, freedoms_ /= 2;
  noise_ = std::clamp(std::sqrt(squares_ / freedoms_), 1e-6, options_.tolerance);
}

void BodyFollower::report(Timestamp now) {
  poses_.clear();
  for (std::size_t b = 0; b < followed_.size(); ++b) {
    Followed& one = followed_[b];
    FollowCounts& counts = counts_[b];
    if (one.measured) {
      const auto seen = std::count_if(one.point_of.begin(), one.point_of.end(), [](int point) { return point >= 0; });
      learn_noise(*one.fit, static_cast<std::size_t>(seen));
      one.present = true;
      one.seen_at = now;
      one.seen_pose = one.fit->world_from_body;
      one.seen_rate = one.motion->turning_rate;
      ++counts.measured;
      poses_.push_back({.body = bodies_[b].id,
                        .world_from_body = one.fit->world_from_body,
                        .covariance = one.fit->covariance,
                        .residual_m = one.fit->mean_error,
                        .tracked = true});
      continue;
    }
    if (!one.present || seconds(now - one.seen_at) > options_.predict_s) {
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
    pose.covariance->diagonal() << Vector<3>::Constant(one.motion->turn.value), Vector<3>::Constant(one.motion->place.value);
    if (one.fit) pose.covariance = one.fit->covariance, pose.residual_m = one.fit->mean_error;
    poses_.push_back(pose);
  }
}

}  // namespace marey::solve::bodies
