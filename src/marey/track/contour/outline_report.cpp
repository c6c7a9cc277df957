// What a target's filters hold becomes the outline that others read. Three slots a target: a reader may still hold one.
#include "marey/track/contour/outline_report.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "marey/track/contour/silhouette_spline.h"

namespace marey::track::contour {
namespace {

constexpr double kMaxHigher = 1.25;  // of the tracker's box, from which on an outline has grown beyond its target
constexpr double kMaxWider = 1.8;    // likewise

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

/// px: the middle of a box's lower edge, between pixels.
Vector<2> foot_of(const Box& box) {
  return {box.left + box.width / 2 - 0.5, box.bottom() - 0.5};
}

geometry::ClosedSpline moved_and_scaled(const geometry::ClosedSpline& spline, const Vector<2>& from, double by,
                                        const Vector<2>& to) {
  std::vector<Vector<2>> points = spline.control_points();
  for (Vector<2>& point : points) point = to + by * (point - from);
  return {spline.order(), std::move(points)};
}

double width_of(const Box& box) {
  return std::max(box.width, kStrideWidth * box.height);
}

/// Whether the silhouette of one target alone explains what is unlike the tracker's box: a body that bends or squats keeps its
/// feet.
bool is_explained(const Box& own, const Box& box, const Detection* raw) {
  if (raw == nullptr || raw->group) return false;
  const bool cut = box.bottom() - own.bottom() > kMaxMissingPart * box.height;
  return !cut && own.height < kMaxHigher * raw->box.height && own.width < kMaxWider * width_of(raw->box);
}

/// The end of a cut shape that is nearer to the box's is where the body's is.
Vector<2> shift_to_visible_end(const Box& body, const Box& own, const Box& box) {
  const double top = own.top - box.top, bottom = own.bottom() - box.bottom();
  const double down = std::abs(top) < std::abs(bottom) ? own.top - body.top : own.bottom() - body.bottom();
  return {own.centre().x() - body.centre().x(), std::clamp(down, -kMaxMissingPart * box.height, kMaxMissingPart * box.height)};
}

/// Whether a curve is about as high as the box, px, and not much wider.
bool is_as_large(const geometry::ClosedSpline& spline, const Box& box) {
  const Box own = spline.box();
  return own.height > (1 - kMaxMissingPart) * box.height && own.height < kMaxHigher * box.height &&
         own.width < kMaxWider * width_of(box);
}

/// The last shape of the target that filled the tracker's box, put into `box`, px; nothing before there was one.
std::optional<geometry::ClosedSpline> body_in(const ContourTarget& target, const Box& box) {
  if (!target.body_shape) return std::nullopt;
  geometry::ClosedSpline body = moved_and_scaled(*target.body_shape, Vector<2>::Zero(), box.height, foot_of(box));
  return is_as_large(body, box) ? std::optional(std::move(body)) : std::nullopt;
}

}  // namespace

void bring_back(ContourTarget& target, const Track<2>& track, const Detection* raw) {
  const Vector<2> centre = target.motion.centre();
  const Box& box = *track.box;
  const geometry::ClosedSpline& spline = target.shape.spline();
  const Box own = spline.box();
  if (is_as_large(spline, box)) {
    if (target.state == Outline::State::detected)
      target.body_shape = moved_and_scaled(spline, foot_of(own), 1 / box.height, Vector<2>::Zero());
  } else if (!is_explained(own, box, raw)) {
    auto body = body_in(target, box);
    if (!body) body = standing_body(box, {spline.order(), spline.count(), spline.count()});
    const Vector<2> shift = body ? shift_to_visible_end(body->box(), own, box) : Vector<2>(0, 0);
    if (body) target.shape = ShapeFilter(moved_and_scaled(*body, Vector<2>::Zero(), 1, shift), 2 * prior_deviation(target.height));
    target.state = Outline::State::held;
    target.lines.clear();
    target.hidden.resize(static_cast<std::size_t>(target.shape.spline().count()));
    std::iota(target.hidden.begin(), target.hidden.end(), 0);
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
