#include "marey/track/ball/ball_birth.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace marey::track::ball {
namespace {

/// An object seen at the same place for seconds begins nothing.
constexpr double kPaint = -5;  // logarithm of 1/px²

struct Detected {
  int view, index;
  double weight;  // logarithm: of its appearance, over how densely false things are seen there
  Ray ray;
  double metres_a_pixel;  // across the ray, at 1 m
};

double log_area(const GroundView& ground) {
  return std::log(static_cast<double>(ground.size().width) * ground.size().height);
}

std::vector<Detected> beginnings(const BallObservations& time_step, const GroundViews& views, const BallSearchOptions& options) {
  std::vector<Detected> all;
  for (std::size_t v = 0; v < time_step.views.size(); ++v) {
    const BallView& view = time_step.views[v];
    const GroundView& ground = views.view_at(view.camera, view.time);
    for (std::size_t i = 0; i < view.detected.size(); ++i) {
      const BallSighting& one = view.detected[i];
      const double density = false_density(one, view, ground, options);
      if (one.on_person || density > kPaint) continue;
      const auto ray = ground.camera()->ray(one.pixel), neighbour = ground.camera()->ray(one.pixel + Vector<2>(1, 0));
      if (!ray || !neighbour) continue;
      const double angle = (ray->direction.normalized() - neighbour->direction.normalized()).norm();
      all.push_back({static_cast<int>(v), static_cast<int>(i), one.score - density, *ray, angle});
    }
  }
  return all;
}

BallNode beginning(const std::shared_ptr<BallNode>& before, const BallObservations& time_step, bool flies, const Matrix<3>& spread,
                   const Vector<3>& location, const BallMotionOptions& motion) {
  BallNode initiated;
  initiated.parent = before;
  initiated.step.mode = flies ? BallMode::flying : BallMode::rolling;
  initiated.step.event = BallEvent::kick;
  initiated.step.used.assign(time_step.views.size(), -1);
  initiated.step.initiated = true;
  BallBelief& belief = initiated.step.belief;
  belief.mean.head<3>() = location;
  belief.covariance.setZero();
  belief.covariance.topLeftCorner<3, 3>() = spread;
  const double v = motion.kick_speed;
  belief.covariance.bottomRightCorner<3, 3>() = Vector<3>(v, v, flies ? motion.kick_up : 0.3).cwiseAbs2().asDiagonal();
  return initiated;
}

/// Seen by one camera: on the ground, or at one of some heights.
void initiate_from_one_view(const Detected& detected, const std::shared_ptr<BallNode>& before, const BallObservations& time_step,
                            const GroundViews& views, const BallSearchOptions& options, std::vector<BallNode>& out) {
  const BallView& view = time_step.views[static_cast<std::size_t>(detected.view)];
  const BallSighting& sighting = view.detected[static_cast<std::size_t>(detected.index)];
  const GroundView& ground = views.view_at(view.camera, view.time);
  const auto met = ground.location(sighting.pixel);
  const Vector<3> centre = ground.camera()->centre();
  if (!met || centre.z() <= 0) return;
  const Vector<3> foot(met->ground.x(), met->ground.y(), 0);
  for (const double height : {kBallRadius, 2.0, 5.0}) {
    const bool flies = height > 1;
    const double fraction = height / centre.z();
    if (!(fraction < 0.9)) continue;
    const double across = std::max(0.05, sighting.sigma * detected.metres_a_pixel * (centre - foot).norm());
    const Vector<3> metre_up = (centre - foot) / centre.z();
    const Matrix<3> spread = across * across * Matrix<3>::Identity() + (flies ? 1.0 : 1e-3) * metre_up * metre_up.transpose();
    BallNode initiated = beginning(before, time_step, flies, spread, foot + fraction * (centre - foot), options.motion);
    initiated.step.used[static_cast<std::size_t>(detected.view)] = detected.index;
    initiated.step.evidence =
        std::log(options.p_initiated * options.found * (flies ? 0.1 : 0.8)) - log_area(ground) + detected.weight;
    initiated.score = before->score + initiated.step.evidence;
    out.push_back(std::move(initiated));
  }
}

/// Seen by two, whose rays meet: the least squares of the distances from both, each by what a pixel is there.
void initiate_from_two_views(const Detected& a, const Detected& b, const std::shared_ptr<BallNode>& before,
                             const BallObservations& time_step, const GroundViews& views, const BallSearchOptions& options,
                             std::vector<BallNode>& out) {
  const Vector<3> da = a.ray.direction.normalized(), db = b.ray.direction.normalized();
  constexpr double kMinSine = 0.1;
  if (da.cross(db).norm() < kMinSine) return;
  Matrix<3> across_a = Matrix<3>::Identity() - da * da.transpose(), across_b = Matrix<3>::Identity() - db * db.transpose();
  Vector<3> location = (across_a + across_b).ldlt().solve(across_a * a.ray.origin + across_b * b.ray.origin);
  const double sigma_a = 0.02 + 0.7 * a.metres_a_pixel * (location - a.ray.origin).norm(),
               sigma_b = 0.02 + 0.7 * b.metres_a_pixel * (location - b.ray.origin).norm();
  across_a /= sigma_a * sigma_a, across_b /= sigma_b * sigma_b;
  const Matrix<3> information = across_a + across_b;
  location = information.ldlt().solve(across_a * a.ray.origin + across_b * b.ray.origin);
  const auto off = [&](const Detected& detected, const Matrix<3>& across) {
    const Vector<3> away = location - detected.ray.origin;
    return away.dot(across * away);
  };
  const double squared = off(a, across_a) + off(b, across_b);
  constexpr double kMaxLevel = 30;  // m
  if (squared > options.gate * options.gate || location.z() < -0.3 || location.z() > kMaxLevel) return;
  if ((location - a.ray.origin).dot(da) < 0 || (location - b.ray.origin).dot(db) < 0) return;
  const BallView& other = time_step.views[static_cast<std::size_t>(b.view)];
  const Ray& from = b.ray;
  const double line = (location - from.origin).norm() * b.metres_a_pixel;  // m a pixel, there
  for (const bool flies : {false, true}) {
    if (!flies && location.z() > 0.5) continue;
    BallNode initiated = beginning(before, time_step, flies, information.inverse(), location, options.motion);
    if (!flies) initiated.step.belief.mean.z() = kBallRadius;
    initiated.step.used[static_cast<std::size_t>(a.view)] = a.index;
    initiated.step.used[static_cast<std::size_t>(b.view)] = b.index;
    const GroundView& ground = views.view_at(other.camera, other.time);
    // The second one lies along the first one's ray, anywhere on a line of its image.
    const double length = std::log(static_cast<double>(ground.size().width)) + std::log(std::max(1.0, sigma_b / line));
    initiated.step.evidence = std::log(options.p_initiated * options.found * options.found * (flies ? 0.3 : 0.7)) -
                              log_area(ground) + a.weight + b.weight - length - 0.5 * squared;
    initiated.score = before->score + initiated.step.evidence;
    out.push_back(std::move(initiated));
  }
}

}  // namespace

double false_density(const BallSighting& sighting, const BallView& view, const GroundView& ground,
                     const BallSearchOptions& options) {
  if (sighting.false_density) return std::log(*sighting.false_density);
  return std::log(std::max(options.false_observed, static_cast<double>(view.detected.size()))) - log_area(ground);
}

void initiate(const std::shared_ptr<BallNode>& before, const BallObservations& time_step, const GroundViews& views,
              const BallSearchOptions& options, std::vector<BallNode>& out) {
  const std::vector<Detected> all = beginnings(time_step, views, options);
  for (std::size_t i = 0; i < all.size(); ++i) {
    initiate_from_one_view(all[i], before, time_step, views, options, out);
    for (std::size_t k = i + 1; k < all.size(); ++k) {
      if (all[k].view != all[i].view) initiate_from_two_views(all[i], all[k], before, time_step, views, options, out);
    }
  }
}

}  // namespace marey::track::ball
