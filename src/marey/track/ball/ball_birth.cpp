#include "marey/track/ball/ball_birth.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace marey::track::ball {
namespace {

/// What is seen at the same place for seconds begins nothing.
constexpr double kPaint = -5;  // logarithm of 1/px²

struct Seen {
  int view, index;
  double weight;  // logarithm: of its look, over how densely false things are seen there
  Ray ray;
  double metres_a_pixel;  // across the ray, at 1 m
};

double log_area(const GroundView& ground) {
  return std::log(static_cast<double>(ground.size().width) * ground.size().height);
}

std::vector<Seen> beginnings(const BallMoment& moment, const GroundViews& views, const BallSearchOptions& options) {
  std::vector<Seen> all;
  for (std::size_t v = 0; v < moment.views.size(); ++v) {
    const BallView& view = moment.views[v];
    const GroundView& ground = views.view_at(view.camera, view.time);
    for (std::size_t i = 0; i < view.seen.size(); ++i) {
      const BallSighting& one = view.seen[i];
      const double density = false_density(one, view, ground, options);
      if (one.on_person || density > kPaint) continue;
      const auto ray = ground.camera()->ray(one.pixel), beside = ground.camera()->ray(one.pixel + Vector<2>(1, 0));
      if (!ray || !beside) continue;
      const double angle = (ray->direction.normalized() - beside->direction.normalized()).norm();
      all.push_back({static_cast<int>(v), static_cast<int>(i), one.score - density, *ray, angle});
    }
  }
  return all;
}

BallNode beginning(const std::shared_ptr<BallNode>& before, const BallMoment& moment, bool flies, const Matrix<3>& spread,
                   const Vector<3>& place, const BallMotionOptions& motion) {
  BallNode born;
  born.parent = before;
  born.step.mode = flies ? BallMode::flying : BallMode::rolling;
  born.step.event = BallEvent::kick;
  born.step.used.assign(moment.views.size(), -1);
  born.step.born = true;
  BallBelief& belief = born.step.belief;
  belief.mean.head<3>() = place;
  belief.covariance.setZero();
  belief.covariance.topLeftCorner<3, 3>() = spread;
  const double v = motion.kick_speed;
  belief.covariance.bottomRightCorner<3, 3>() = Vector<3>(v, v, flies ? motion.kick_up : 0.3).cwiseAbs2().asDiagonal();
  return born;
}

/// Seen by one camera: on the ground, or at one of some heights.
void be_seen_once(const Seen& seen, const std::shared_ptr<BallNode>& before, const BallMoment& moment, const GroundViews& views,
                  const BallSearchOptions& options, std::vector<BallNode>& out) {
  const BallView& view = moment.views[static_cast<std::size_t>(seen.view)];
  const BallSighting& sighting = view.seen[static_cast<std::size_t>(seen.index)];
  const GroundView& ground = views.view_at(view.camera, view.time);
  const auto met = ground.place(sighting.pixel);
  const Vector<3> centre = ground.camera()->centre();
  if (!met || centre.z() <= 0) return;
  const Vector<3> foot(met->ground.x(), met->ground.y(), 0);
  for (const double height : {kBallRadius, 2.0, 5.0}) {
    const bool flies = height > 1;
    const double share = height / centre.z();
    if (!(share < 0.9)) continue;
    const double across = std::max(0.05, sighting.sigma * seen.metres_a_pixel * (centre - foot).norm());
    const Vector<3> metre_up = (centre - foot) / centre.z();
    const Matrix<3> spread = across * across * Matrix<3>::Identity() + (flies ? 1.0 : 1e-3) * metre_up * metre_up.transpose();
    BallNode born = beginning(before, moment, flies, spread, foot + share * (centre - foot), options.motion);
    born.step.used[static_cast<std::size_t>(seen.view)] = seen.index;
    born.step.evidence = std::log(options.p_born * options.found * (flies ? 0.1 : 0.8)) - log_area(ground) + seen.weight;
    born.score = before->score + born.step.evidence;
    out.push_back(std::move(born));
  }
}

/// Seen by two, whose rays meet: the least squares of the distances from both, each by what a pixel is there.
void be_seen_twice(const Seen& a, const Seen& b, const std::shared_ptr<BallNode>& before, const BallMoment& moment,
                   const GroundViews& views, const BallSearchOptions& options, std::vector<BallNode>& out) {
  const Vector<3> da = a.ray.direction.normalized(), db = b.ray.direction.normalized();
  constexpr double kLeastSine = 0.1;
  if (da.cross(db).norm() < kLeastSine) return;
  Matrix<3> across_a = Matrix<3>::Identity() - da * da.transpose(), across_b = Matrix<3>::Identity() - db * db.transpose();
  Vector<3> place = (across_a + across_b).ldlt().solve(across_a * a.ray.origin + across_b * b.ray.origin);
  const double sigma_a = 0.02 + 0.7 * a.metres_a_pixel * (place - a.ray.origin).norm(),
               sigma_b = 0.02 + 0.7 * b.metres_a_pixel * (place - b.ray.origin).norm();
  across_a /= sigma_a * sigma_a, across_b /= sigma_b * sigma_b;
  const Matrix<3> information = across_a + across_b;
  place = information.ldlt().solve(across_a * a.ray.origin + across_b * b.ray.origin);
  const auto off = [&](const Seen& seen, const Matrix<3>& across) {
    const Vector<3> away = place - seen.ray.origin;
    return away.dot(across * away);
  };
  const double squared = off(a, across_a) + off(b, across_b);
  constexpr double kHighest = 30;  // m
  if (squared > options.gate * options.gate || place.z() < -0.3 || place.z() > kHighest) return;
  if ((place - a.ray.origin).dot(da) < 0 || (place - b.ray.origin).dot(db) < 0) return;
  const BallView& other = moment.views[static_cast<std::size_t>(b.view)];
  const Ray& from = b.ray;
  const double line = (place - from.origin).norm() * b.metres_a_pixel;  // m a pixel, there
  for (const bool flies : {false, true}) {
    if (!flies && place.z() > 0.5) continue;
    BallNode born = beginning(before, moment, flies, information.inverse(), place, options.motion);
    if (!flies) born.step.belief.mean.z() = kBallRadius;
    born.step.used[static_cast<std::size_t>(a.view)] = a.index;
    born.step.used[static_cast<std::size_t>(b.view)] = b.index;
    const GroundView& ground = views.view_at(other.camera, other.time);
    // The second one lies along the first one's ray, anywhere on a line of its picture.
    const double length = std::log(static_cast<double>(ground.size().width)) + std::log(std::max(1.0, sigma_b / line));
    born.step.evidence = std::log(options.p_born * options.found * options.found * (flies ? 0.3 : 0.7)) - log_area(ground) +
                         a.weight + b.weight - length - 0.5 * squared;
    born.score = before->score + born.step.evidence;
    out.push_back(std::move(born));
  }
}

}  // namespace

double false_density(const BallSighting& sighting, const BallView& view, const GroundView& ground,
                     const BallSearchOptions& options) {
  if (sighting.false_density) return std::log(*sighting.false_density);
  return std::log(std::max(options.false_seen, static_cast<double>(view.seen.size()))) - log_area(ground);
}

void be_born(const std::shared_ptr<BallNode>& before, const BallMoment& moment, const GroundViews& views,
             const BallSearchOptions& options, std::vector<BallNode>& out) {
  const std::vector<Seen> all = beginnings(moment, views, options);
  for (std::size_t i = 0; i < all.size(); ++i) {
    be_seen_once(all[i], before, moment, views, options, out);
    for (std::size_t k = i + 1; k < all.size(); ++k) {
      if (all[k].view != all[i].view) be_seen_twice(all[i], all[k], before, moment, views, options, out);
    }
  }
}

}  // namespace marey::track::ball
