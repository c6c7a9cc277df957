#include "marey/reconstruct/sight_line.h"

namespace marey::reconstruct {

std::optional<SightLine> sight_line(const Camera& camera, int number, const Vector<2>& pixel, double sigma) {
  const auto ray = camera.ray(pixel);
  if (!ray) return std::nullopt;
  const auto at = camera.project_with_jacobian(ray->origin + ray->direction);
  if (!at) return std::nullopt;
  return SightLine{number, ray->origin, ray->direction, at->by_world, sigma};
}

}  // namespace marey::reconstruct
