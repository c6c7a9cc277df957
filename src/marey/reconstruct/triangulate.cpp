#include "marey/reconstruct/triangulate.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/LU>

namespace marey::reconstruct {
namespace {

constexpr int kMaxSteps = 25;            // numerical: it ends earlier where it settles
constexpr double kSmallStep = 1e-3;      // standard deviations of the point, numerical: far below noise
constexpr double kMaxDistance = 1e6;     // m
constexpr double kDistinctlyBetter = 3;  // a left-out ray is known for the wrong one where any other fits worse by this factor

/// The point with the least sum of squared distances to the half-lines' lines; nothing if they are parallel.
std::optional<Vector<3>> nearest_to_all(std::span<const SightLine> rays, std::uint64_t used) {
  Matrix<3> A = Matrix<3>::Zero();
  Vector<3> b = Vector<3>::Zero();
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!(used >> i & 1)) continue;
    const Matrix<3> across = Matrix<3>::Identity() - rays[i].direction * rays[i].direction.transpose();
    A += across;
    b += across * rays[i].origin;
  }
  const double determinant = A.determinant();
  if (!(determinant > 1e-12)) return std::nullopt;
  return A.inverse() * b;
}

/// Cosine of the angle between a ray and the ray farthest from it: within a factor of two of the widest angle of all.
bool wide_enough(std::span<const SightLine> rays, std::uint64_t used, double min_angle) {
  const Vector<3>& first = rays[std::countr_zero(used)].direction;
  double least_cosine = 1;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    // Opposite rays fix a point along their common line no better than parallel ones.
    if (used >> i & 1) least_cosine = std::min(least_cosine, std::abs(first.dot(rays[i].direction)));
  }
  return least_cosine < std::cos(min_angle);
}

double limit_of(int rays, double false_alarm) {
  // z such that a normal variable exceeds it with the given probability: Abramowitz & Stegun 26.2.23.
  const double t = std::sqrt(-2 * std::log(std::min(false_alarm, 0.5)));
  const double z = t - (2.515517 + t * (0.802853 + t * 0.010328)) / (1 + t * (1.432788 + t * (0.189269 + t * 0.001308)));
  const double degrees = std::max(1, 2 * rays - 3);
  const double root = 1 - 2 / (9 * degrees) + z * std::sqrt(2 / (9 * degrees));
  return degrees * root * root * root;
}

std::uint64_t all_of(std::span<const SightLine> rays) {
  return rays.size() >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << rays.size()) - 1;
}

}  // namespace

struct Triangulator::Fit {
  Vector<3> position;
  Matrix<3> information;
  double chi_square = 0;
};

/// The result without one ray.
struct Triangulator::Rejection {
  Fit fit;
  std::uint64_t used;
};

Triangulator::Triangulator(const TriangulateOptions& options) : options_(options) {
  for (int rays = 2; rays <= kMaxRays; ++rays) limits_[rays] = limit_of(rays, options.false_alarm);
}

/// Gauss and Newton's method with Huber's weights.
std::variant<Triangulator::Fit, NoPoint> Triangulator::fit(std::span<const SightLine> rays, std::uint64_t used,
                                                           const Vector<3>& start) const {
  const double huber = options_.huber;
  Fit fit{start, Matrix<3>::Zero(), 0};
  for (int step = 0; step < kMaxSteps; ++step) {
    Matrix<3> H = Matrix<3>::Zero();
    Vector<3> g = Vector<3>::Zero();
    fit.chi_square = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (!(used >> i & 1)) continue;
      const SightLine& ray = rays[i];
      const Vector<3> p = fit.position - ray.origin;
      const double depth = ray.direction.dot(p);
      if (!(depth > 0)) return NoPoint::behind_camera;
      const double scale = 1 / (depth * ray.sigma);
      const Vector<2> error = ray.across * p * scale;
      const Eigen::Matrix<double, 2, 3> J = ray.across * scale - error * ray.direction.transpose() / depth;
      const double square = error.squaredNorm();
      const double weight = square > huber * huber ? huber / std::sqrt(square) : 1;
      fit.chi_square += square;
      H.noalias() += weight * J.transpose() * J;
      g.noalias() += weight * J.transpose() * error;
    }
    fit.information = H;
    const double determinant = H.determinant();
    if (!(determinant > 0) || !std::isfinite(determinant)) return NoPoint::no_solution;
    const Vector<3> move = H.inverse() * g;
    const double size = move.dot(g);  // squared, in standard deviations of the point
    fit.position -= move;
    if (!(fit.position.squaredNorm() < kMaxDistance * kMaxDistance)) return NoPoint::no_solution;
    if (size < kSmallStep * kSmallStep) break;
  }
  return fit;  // rays far apart approach their compromise slowly; their sum of squares shows that they do not meet
}

/// The best fit without one of the rays, and which; nothing if none is sound, or two could be the wrong one.
std::optional<Triangulator::Rejection> Triangulator::without_one(std::span<const SightLine> rays, std::uint64_t used) const {
  std::optional<Rejection> best;
  double second = std::numeric_limits<double>::infinity();
  for (std::uint64_t left = used; left != 0; left &= left - 1) {
    const std::uint64_t rest = used & ~(left & ~(left - 1));
    const auto start = nearest_to_all(rays, rest);
    if (!start || !wide_enough(rays, rest, options_.min_angle)) continue;
    const auto tried = fit(rays, rest, *start);
    const Fit* found = std::get_if<Fit>(&tried);
    if (!found) continue;
    if (!best || found->chi_square < best->fit.chi_square) {
      if (best) second = best->fit.chi_square;
      best = Rejection{*found, rest};
    } else {
      second = std::min(second, found->chi_square);
    }
  }
  if (!best) return std::nullopt;
  // Two rays nearly always meet somewhere: of three, it must be plain that the other pairs do not.
  const double limit = max_chi_square(std::popcount(best->used));
  if (best->fit.chi_square <= limit && std::popcount(best->used) == 2 && second < kDistinctlyBetter * limit) return std::nullopt;
  return best;
}

SpacePoint Triangulator::point_of(std::span<const SightLine> rays, std::uint64_t used, const Fit& fit) {
  SpacePoint point;
  point.position = fit.position;
  point.covariance = fit.information.inverse();
  point.chi_square = fit.chi_square;
  point.used = used;
  point.rays = std::popcount(used);
  double sum = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (used >> i & 1) sum += rays[i].error(fit.position).squaredNorm();
  }
  point.residual_px = std::sqrt(sum / point.rays);
  return point;
}

Triangulation Triangulator::solve(std::span<const SightLine> rays, std::uint64_t used, const Vector<3>& start) const {
  const auto first = fit(rays, used, start);
  if (const auto* reason = std::get_if<NoPoint>(&first); reason && (!options_.reject || std::popcount(used) < 3)) return *reason;
  const Fit* sound = std::get_if<Fit>(&first);
  if (sound && sound->chi_square <= max_chi_square(std::popcount(used))) return point_of(rays, used, *sound);
  if (!options_.reject) return NoPoint::rays_disagree;
  while (std::popcount(used) > 2) {
    const auto better = without_one(rays, used);
    if (!better) break;
    used = better->used;
    if (better->fit.chi_square <= max_chi_square(std::popcount(used))) return point_of(rays, used, better->fit);
  }
  return NoPoint::rays_disagree;
}

std::string_view meaning(NoPoint reason) {
  switch (reason) {
    case NoPoint::too_few_rays:
      return "fewer than two rays";
    case NoPoint::parallel_rays:
      return "the rays are parallel, so that the distance would be a guess";
    case NoPoint::behind_camera:
      return "the rays meet behind a camera";
    case NoPoint::rays_disagree:
      return "the rays pass each other by more than noise explains";
    case NoPoint::no_solution:
      return "no point is near the rays";
  }
  return "";
}

Triangulation Triangulator::operator()(std::span<const SightLine> rays) const {
  if (rays.size() > kMaxRays) rays = rays.first(kMaxRays);
  if (rays.size() < 2) return NoPoint::too_few_rays;
  const std::uint64_t used = all_of(rays);
  if (!wide_enough(rays, used, options_.min_angle)) return NoPoint::parallel_rays;
  const auto start = nearest_to_all(rays, used);
  if (!start) return NoPoint::parallel_rays;
  return solve(rays, used, *start);
}

Triangulation Triangulator::operator()(std::span<const SightLine> rays, const Vector<3>& near) const {
  if (rays.size() > kMaxRays) rays = rays.first(kMaxRays);
  if (rays.size() < 2) return NoPoint::too_few_rays;
  const std::uint64_t used = all_of(rays);
  if (!wide_enough(rays, used, options_.min_angle)) return NoPoint::parallel_rays;
  return solve(rays, used, near);
}

}  // namespace marey::reconstruct
