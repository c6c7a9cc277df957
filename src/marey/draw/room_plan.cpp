#include "marey/draw/room_plan.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "marey/draw/svg.h"

namespace marey::draw {
namespace {

constexpr double kPlanWidth = 900, kPlanMargin = 40, kPlanHead = 64;  // of the drawing
constexpr double kBeyond = 0.6;                                       // m round the mounts
constexpr double kRayM = 0.9;                                         // of a camera's view

/// From the room's m to the drawing.
struct PlanFrame {
  Vector<2> lowest, highest;
  double scale = 1;

  Vector<2> at(const Vector<2>& location) const {
    return {kPlanMargin + scale * (location.x() - lowest.x()), kPlanHead + scale * (highest.y() - location.y())};
  }
  Box box(const Vector<2>& from, const Vector<2>& to) const {
    const Vector<2> corner = at({from.x(), to.y()});
    return {corner.x(), corner.y(), scale * (to.x() - from.x()), scale * (to.y() - from.y())};
  }
  double height() const { return kPlanHead + scale * (highest.y() - lowest.y()) + kPlanMargin; }
};

PlanFrame frame_of(const RoomPlan& plan) {
  PlanFrame frame{plan.room.volume.from.head<2>(), plan.room.volume.to.head<2>()};
  const auto extend = [&](const Vector<2>& location) {
    frame.lowest = frame.lowest.cwiseMin(location);
    frame.highest = frame.highest.cwiseMax(location);
  };
  for (const Vector<3>& mount : plan.room.mounts) extend(mount.head<2>());
  for (const RoomPlan::Camera& camera : plan.cameras) extend(camera.at);
  frame.lowest -= Vector<2>::Constant(kBeyond);
  frame.highest += Vector<2>::Constant(kBeyond);
  frame.scale = (kPlanWidth - 2 * kPlanMargin) / (frame.highest.x() - frame.lowest.x());
  return frame;
}

void add_cells(Svg& svg, const RoomPlan& plan, const PlanFrame& frame) {
  for (const RoomPlan::Cell& cell : plan.cells) {
    const Box box = frame.box(cell.from, cell.to);
    svg.rect(
        box,
        {{"fill", "#3a9d5d"}, {"fill-opacity", fmt::format("{:.2f}", 0.75 * cell.covered * cell.covered)}, {"stroke", "#fff"}});
    const double size = std::clamp(box.height / 3.2, 5.0, 13.0);
    const Vector<2> middle(box.left + box.width / 2, box.top + box.height / 2);
    svg.text(middle - Vector<2>(0, 0.15 * size), fmt::format("{:.0f} %", 100 * cell.covered),
             {{"text-anchor", "middle"}, {"font-size", size}});
    if (cell.covered > 0)
      svg.text(middle + Vector<2>(0, size), fmt::format("{:.1f} mm", 1000 * cell.error_m),
               {{"text-anchor", "middle"}, {"font-size", 0.85 * size}, {"fill", "#333"}});
  }
}

void add_camera(Svg& svg, const RoomPlan::Camera& camera, const PlanFrame& frame) {
  const double angle = std::atan2(camera.ahead.y(), camera.ahead.x());
  const auto beside = [&](double turn) -> Vector<2> {
    return camera.at + kRayM * Vector<2>(std::cos(angle + turn), std::sin(angle + turn));
  };
  const std::array<Vector<2>, 3> view{frame.at(camera.at), frame.at(beside(camera.field_of_view / 2)),
                                      frame.at(beside(-camera.field_of_view / 2))};
  svg.polygon(view, {{"fill", "#2a7de1"}, {"fill-opacity", "0.25"}});
  svg.circle(view[0], 6, {{"fill", "#2a7de1"}});
  svg.text(view[0] - Vector<2>(0, 11), fmt::format("{} ({:.1f} m)", camera.name, camera.height),
           {{"text-anchor", "middle"}, {"font-size", 13}});
}

}  // namespace

std::string to_svg(const RoomPlan& plan) {
  const PlanFrame frame = frame_of(plan);
  Svg svg(kPlanWidth, frame.height(), 12);
  svg.set({{"width", kPlanWidth}, {"height", std::round(frame.height())}});
  svg.text({kPlanMargin, 26}, plan.title, {{"font-size", 17}});
  svg.text({kPlanMargin, 48}, plan.caption, {{"fill", "#555"}, {"font-size", 13}});
  add_cells(svg, plan, frame);
  svg.rect(frame.box(plan.room.volume.from.head<2>(), plan.room.volume.to.head<2>()),
           {{"fill", "none"}, {"stroke", "#3a9d5d"}, {"stroke-width", 2}});
  for (const RoomBox& box : plan.room.obstacles)
    svg.rect(frame.box(box.from.head<2>(), box.to.head<2>()), {{"fill", "#777"}, {"fill-opacity", "0.6"}});
  for (const Vector<3>& mount : plan.room.mounts) svg.circle(frame.at(mount.head<2>()), 2, {{"fill", "#bbb"}});
  for (const RoomPlan::Camera& camera : plan.cameras) add_camera(svg, camera, frame);
  return svg.str();
}

}  // namespace marey::draw
