#include "marey/reconstruct/epipolar.h"

#include <algorithm>
#include <cmath>

namespace marey::reconstruct {
namespace {

constexpr double kMinBaseline = 1e-6;  // m, numerical: cameras in one place
constexpr double kMinSine = 0.03;      // rays closer to the line of centres, or to each other, give no depth
constexpr double kTurn = 4;            // by definition: numbers on the pencil go round once in this

/// A number that grows with the angle of (x, y) as atan2 does, from −2 to 2, without its cost.
double turn_of(double x, double y) {
  const double slope = y / (std::abs(x) + std::abs(y));
  return x >= 0 ? slope : y >= 0 ? 2 - slope : -2 - slope;
}

Vector<3> axis_of(const Camera& camera) {
  return camera.camera_from_world().rotation.row(2);
}

}  // namespace

EpipolarMatcher::EpipolarMatcher(const Camera& a, int number_a, const Camera& b, int number_b) : a_(number_a), b_(number_b) {
  const Vector<3> between = b.centre() - a.centre();
  baseline_ = between.norm();
  if (baseline_ < kMinBaseline) return;
  along_ = between / baseline_;
  const Vector<3> ahead = axis_of(a) + axis_of(b);
  aside_ = ahead - ahead.dot(along_) * along_;
  if (aside_.norm() < 1e-3) aside_ = along_.unitOrthogonal();
  aside_.normalize();
  up_ = along_.cross(aside_);
  quality_ = axis_of(a).cross(axis_of(b)).norm();
}

void EpipolarMatcher::list(const FrameRays& frame, std::span<const char> taken, int camera, std::vector<Entry>& entries) const {
  entries.clear();
  for (int ray = frame.first(camera); ray < frame.last(camera); ++ray) {
    if (taken[ray]) continue;
    const SightLine& line = frame.line(ray);
    const double x = line.direction.dot(aside_), y = line.direction.dot(up_);
    const double aside = std::hypot(x, y);
    if (aside < kMinSine) continue;
    const double sum = std::abs(x) + std::abs(y);
    // Noise across the half-plane turns it by noise / sine; the number changes with the angle by (aside / sum)².
    const double tolerance = line.sigma / line.scale() * aside / (sum * sum);
    entries.push_back({turn_of(x, y), tolerance, line.direction.dot(along_), aside, ray});
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& p, const Entry& q) { return p.plane < q.plane; });
}

void EpipolarMatcher::match(const FrameRays& frame, std::span<const char> taken, double sigmas, std::vector<EpipolarPair>& pairs) {
  if (baseline_ < kMinBaseline) return;
  list(frame, taken, a_, of_a_);
  list(frame, taken, b_, of_b_);
  double widest = 0;
  for (const Entry& entry : of_b_) widest = std::max(widest, entry.tolerance);
  const auto consider = [&](const Entry& p, double low, double high, double rotated) {
    auto from = std::lower_bound(of_b_.begin(), of_b_.end(), low, [](const Entry& q, double value) { return q.plane < value; });
    for (; from != of_b_.end() && from->plane <= high; ++from) {
      const double difference = from->plane - p.plane + rotated;
      if (difference * difference > sigmas * sigmas * (p.tolerance * p.tolerance + from->tolerance * from->tolerance)) continue;
      const double sine = from->aside * p.along - from->along * p.aside;  // of the angle at which they meet
      if (sine < kMinSine) continue;
      const double depth = baseline_ * from->aside / sine;
      const SightLine& line = frame.line(p.ray);
      pairs.push_back({p.ray, from->ray, line.origin + depth * line.direction, sine});
    }
  };
  for (const Entry& p : of_a_) {
    const double reach = sigmas * (p.tolerance + widest);
    consider(p, p.plane - reach, p.plane + reach, 0);
    if (p.plane - reach < -kTurn / 2) consider(p, p.plane - reach + kTurn, kTurn / 2, -kTurn);
    if (p.plane + reach > kTurn / 2) consider(p, -kTurn / 2, p.plane + reach - kTurn, kTurn);
  }
}

}  // namespace marey::reconstruct
