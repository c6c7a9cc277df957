#include "marey/track/bramble/person_cylinder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace marey::track::bramble {
namespace {

struct Circle {
  double height, radius;  // of the stature; m at girth 1
};
/// Soles, calves, hips, shoulders, neck, crown.
constexpr std::array<Circle, 6> kProfile{{{0.0, 0.13}, {0.25, 0.17}, {0.5, 0.19}, {0.8, 0.23}, {0.87, 0.11}, {1.0, 0.08}}};

}  // namespace

CylinderOutline cylinder_outline(const Camera& camera, const PersonCylinder& person) {
  Vector<2> away = person.foot.head<2>() - camera.centre().head<2>();
  const double distance = away.norm();
  away = distance > 1e-9 ? Vector<2>(away / distance) : Vector<2>(0, 1);
  const Vector<3> ahead(away.x(), away.y(), 0), side(-away.y(), away.x(), 0);
  std::array<Vector<2>, kProfile.size()> left, right;
  for (std::size_t i = 0; i < kProfile.size(); ++i) {
    const Vector<3> middle = person.foot + Vector<3>(0, 0, kProfile[i].height * person.stature);
    const double radius = kProfile[i].radius * person.girth;
    const auto one = camera.project(middle + radius * side), other = camera.project(middle - radius * side);
    if (!one || !other) return {};
    left[i] = *one, right[i] = *other;
  }
  const Vector<3> crown = person.foot + Vector<3>(0, 0, person.stature);
  const auto nearest = camera.project(person.foot - kProfile.front().radius * person.girth * ahead);
  const auto farthest = camera.project(crown + kProfile.back().radius * person.girth * ahead);
  if (!nearest || !farthest) return {};
  CylinderOutline outline{*nearest};
  outline.insert(outline.end(), left.begin(), left.end());
  outline.push_back(*farthest);
  outline.insert(outline.end(), right.rbegin(), right.rend());
  return outline;
}

void cover(const CylinderOutline& outline, const BlobEvidence& grid, GridShape& shape) {
  shape.rows.clear();
  shape.points = shape.all_rows = shape.top = shape.left = shape.right = 0;
  if (outline.empty()) return;
  const cv::Size size = grid.log_ratio.size();
  double highest = std::numeric_limits<double>::max(), lowest = std::numeric_limits<double>::lowest();
  for (const Vector<2>& corner : outline) {
    const double y = (corner.y() - grid.origin.y()) / grid.step;
    highest = std::min(highest, y), lowest = std::max(lowest, y);
  }
  constexpr double kFar = 30000;  // rows: no person is seen so large
  if (!(highest > -kFar) || !(lowest < kFar)) return;
  const int first = static_cast<int>(std::ceil(highest)), last = static_cast<int>(std::floor(lowest));
  shape.all_rows = std::max(0, last - first + 1);
  const int top = std::max(first, 0), bottom = std::min(last + 1, size.height);
  if (bottom <= top) return;
  thread_local std::vector<double> lows, highs;
  lows.assign(static_cast<std::size_t>(bottom - top), std::numeric_limits<double>::max());
  highs.assign(static_cast<std::size_t>(bottom - top), std::numeric_limits<double>::lowest());
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vector<2> a = (outline[i] - grid.origin) / grid.step;
    const Vector<2> b = (outline[(i + 1) % outline.size()] - grid.origin) / grid.step;
    const int from = std::max(static_cast<int>(std::ceil(std::min(a.y(), b.y()))), top);
    const int to = std::min(static_cast<int>(std::floor(std::max(a.y(), b.y()))), bottom - 1);
    for (int row = from; row <= to; ++row) {
      const double along = a.y() == b.y() ? 0 : (row - a.y()) / (b.y() - a.y());
      const double x = a.x() + along * (b.x() - a.x());
      const auto at = static_cast<std::size_t>(row - top);
      lows[at] = std::min(lows[at], x), highs[at] = std::max(highs[at], x);
    }
  }
  shape.top = top;
  shape.left = size.width;
  for (std::size_t at = 0; at < lows.size(); ++at) {
    const int begin = static_cast<int>(std::clamp(std::ceil(lows[at]), 0.0, static_cast<double>(size.width)));
    const int end =
        static_cast<int>(std::clamp(std::floor(highs[at]) + 1, static_cast<double>(begin), static_cast<double>(size.width)));
    shape.rows.push_back({static_cast<std::int16_t>(begin), static_cast<std::int16_t>(end)});
    shape.points += end - begin;
    if (begin < end) shape.left = std::min(shape.left, begin), shape.right = std::max(shape.right, end);
  }
}

}  // namespace marey::track::bramble
