#include "marey/reconstruct/keypoints/ray_pair.h"

namespace marey::reconstruct::keypoints {
namespace {

constexpr double kMinCrossing = 1e-4;  // squared sine of the angle between the two, numerical: no division by 0

}  // namespace

std::optional<RayPair> pass_of(const SightLine& a, const SightLine& b) {
  const Vector<3> apart = b.origin - a.origin;
  const double cosine = a.direction.dot(b.direction), crossing = 1 - cosine * cosine;
  if (crossing < kMinCrossing) return std::nullopt;
  const double along_a = a.direction.dot(apart), along_b = b.direction.dot(apart);
  const double s = (along_a - cosine * along_b) / crossing, t = (cosine * along_a - along_b) / crossing;
  if (s <= 0 || t <= 0) return std::nullopt;
  RayPair pair;
  pair.position = 0.5 * (a.origin + s * a.direction + b.origin + t * b.direction);
  pair.square =
      a.error(pair.position).squaredNorm() / (a.sigma * a.sigma) + b.error(pair.position).squaredNorm() / (b.sigma * b.sigma);
  return pair;
}

}  // namespace marey::reconstruct::keypoints
