// What a target's filters hold becomes the outline that others read. Three slots a target: a reader may still hold one.
#include "marey/track/contour/outline_report.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "marey/track/contour/silhouette_spline.h"

namespace marey::track::contour {
namespace {

geometry::ClosedSpline moved_to(const geometry::ClosedSpline& spline, const Vector<2>& centre) {
  std::vector<Vector<2>> points = spline.control_points();
  const Vector<2> shift = centre - spline.centroid();
  for (Vector<2>& point : points) point += shift;
  return {spline.order(), std::move(points)};
}

std::shared_ptr<Outline>& free_slot(ContourTarget& target) {
  auto slot = std::find_if(target.slots.begin(), target.slots.end(),
                           [](const std::shared_ptr<Outline>& one) { return one && one.use_count() == 1; });
  if (slot == target.slots.end()) {
    slot = std::find(target.slots.begin(), target.slots.end(), nullptr);
    if (slot == target.slots.end()) slot = target.slots.begin();
    *slot = std::make_shared<Outline>();
  }
  return *slot;
}

/// How high an outline is as a rule, against the tracker's box: as outlines of the target alone are.
double typical_height(const ContourTarget& target, const Box& own) {
  const double part = target.extent.y() > 0 && target.tracked_height > 0 ? target.extent.y() / target.tracked_height : 1;
  return std::min(1.0, part) * own.height;
}

geometry::ClosedSpline scaled(const geometry::ClosedSpline& spline, double by) {
  const Vector<2> centre = spline.centroid();
  std::vector<Vector<2>> points = spline.control_points();
  for (Vector<2>& point : points) point = centre + by * (point - centre);
  return {spline.order(), std::move(points)};
}

}  // namespace

void bring_back(ContourTarget& target, const Track<2>& track) {
  const Vector<2> centre = target.motion.centre();
  const Box& box = *track.box;
  const double height = target.shape.spline().box().height, typical = typical_height(target, box);
  if (height > kMaxHigher * typical) {  // it has grown beyond its target
    target.shape = ShapeFilter(scaled(target.shape.spline(), typical / height), kBend * target.height);
    target.state = Outline::State::held;
    target.lines.clear();
  }
  if (centre.x() >= box.left && centre.x() < box.right() && centre.y() >= box.top && centre.y() < box.bottom()) return;
  target.shape = ShapeFilter(moved_to(target.shape.spline(), box.centre()), kBend * target.height);
  target.motion = MotionFilter(box.centre(), track.velocity, 0, kBend * target.height, target.height, kGrowthAmbiguity);
  target.state = Outline::State::held;
  target.measured.reset();
  target.lines.clear();
}

std::shared_ptr<const Outline> report(ContourTarget& target, const Detection* detected, const Track<2>& track,
                                      const cv::Size& image) {
  const cv::Size* const within = image.empty() ? nullptr : &image;
  const Box own = track.box.value_or(target.box);
  if (!is_outline_of(target.shape.spline(), own, within)) {
    target.shape = ShapeFilter(moved_to(target.predicted, target.motion.centre()), kBend * target.height);
    target.state = Outline::State::held;
    target.lines.clear();
    if (!is_outline_of(target.shape.spline(), own, within)) return nullptr;
  }
  std::shared_ptr<Outline>& slot = free_slot(target);
  Outline& outline = *slot;
  const geometry::ClosedSpline& spline = target.shape.spline();
  outline.order = spline.order();
  outline.control_points = spline.control_points();
  outline.deviations.resize(spline.count());
  for (int i = 0; i < spline.count(); ++i) outline.deviations[i] = target.shape.deviation(i);
  outline.centre = target.motion.centre();
  outline.velocity = target.motion.velocity();
  outline.scale_rate = target.motion.growth();
  outline.centre_deviation = target.motion.centre_deviation();
  outline.velocity_deviation = target.motion.velocity_deviation();
  outline.scale_rate_deviation = target.motion.growth_deviation();
  outline.silhouette = detected != nullptr ? std::optional(detected->centre) : std::nullopt;
  outline.lines = target.lines;
  outline.state = target.state;
  outline.behind = target.behind;
  outline.hidden = target.hidden;
  return slot;
}

}  // namespace marey::track::contour
