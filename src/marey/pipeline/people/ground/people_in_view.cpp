#include "marey/pipeline/people/ground/people_in_view.h"

#include <algorithm>
#include <cmath>

#include "marey/reconstruct/person_view.h"

namespace marey::pipeline::people::ground {

std::optional<Box> person_at(const GroundView& view, const Vector<2>& location) {
  return reconstruct::person_box(*view.camera(), {location.x(), location.y(), view.surface().height(location)});
}

detect::people::PersonSizeMap sizes_over(const GroundView& view, const reconstruct::GroundArea& area, const cv::Rect& part) {
  return {part.size(), [&](double x, double y) -> std::optional<detect::people::PersonSize> {
            const auto location = view.location({x + part.x, y + part.y});
            if (!location || !area.holds(location->ground, kBeyondArea)) return std::nullopt;
            const auto box = person_at(view, location->ground);
            if (!box || box->height < kMinBodyHeight) return std::nullopt;
            return detect::people::PersonSize{box->height, box->width};
          }};
}

cv::Rect part_with_people(const GroundView& view, const reconstruct::GroundArea& area) {
  const cv::Size size = view.size();
  const cv::Rect whole({}, size);
  if (!area.bounded()) return whole;
  constexpr int step = 32;
  std::optional<Box> all;
  // Feet may be below the image while the head is in it.
  for (int y = 0; y < 3 * size.height / 2; y += step) {
    for (int x = -step; x <= size.width + step; x += step) {
      const auto location = view.location({static_cast<double>(x), static_cast<double>(y)});
      if (!location || !area.holds(location->ground, kBeyondArea)) continue;
      const auto box = person_at(view, location->ground);
      if (!box || box->height < kMinBodyHeight) continue;
      all = all ? geometry::hull(*all, *box) : *box;
    }
  }
  if (!all) return whole;
  const auto down = [](double value) { return static_cast<int>(std::floor(value / step)) * step; };
  const cv::Rect found(cv::Point(down(all->left), down(all->top)),
                       cv::Point(down(all->right()) + step, down(all->bottom()) + step));
  const cv::Rect part = found & whole;
  return part.area() > 0 ? part : whole;
}

Box moved(const Box& box, const cv::Point& by) {
  return {box.left + by.x, box.top + by.y, box.width, box.height};
}

}  // namespace marey::pipeline::people::ground
