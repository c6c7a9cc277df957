#include "marey/reconstruct/person_view.h"

#include <algorithm>
#include <cmath>

namespace marey::reconstruct {

std::optional<Box> person_box(const Camera& camera, const Vector<3>& foot, const PersonShape& shape) {
  const Vector<2> away = foot.head<2>() - camera.centre().head<2>();
  const double distance = away.norm();
  if (!(distance > 1e-6)) return std::nullopt;  // right under the camera no person has a width or a height
  const Vector<2> aside = 0.5 * shape.width / distance * Vector<2>(-away.y(), away.x());
  const auto feet = camera.project(foot);
  const auto head = camera.project(foot + Vector<3>(0, 0, shape.height));
  const Vector<3> middle = foot + Vector<3>(0, 0, 0.5 * shape.height);
  const auto one = camera.project(middle + Vector<3>(aside.x(), aside.y(), 0));
  const auto other = camera.project(middle - Vector<3>(aside.x(), aside.y(), 0));
  if (!feet || !head || !one || !other) return std::nullopt;
  const double width = (*one - *other).norm() + std::abs(feet->x() - head->x());
  const double height = std::abs(feet->y() - head->y());
  if (!(width > 0 && height > 0)) return std::nullopt;
  return Box::from_centre(0.5 * (*feet + *head), width, height);
}

}  // namespace marey::reconstruct
