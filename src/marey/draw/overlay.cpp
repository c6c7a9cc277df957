#include "marey/draw/overlay.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/draw/canvas.h"
#include "marey/geometry/bspline.h"

namespace marey::draw {
namespace {

cv::Point2f to_point(const Vector<2>& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y())};
}

/// The outermost pixels that a box covers.
cv::Rect2f edge_of(const Box& box) {
  return {static_cast<float>(box.left), static_cast<float>(box.top), static_cast<float>(std::max(0.0, box.width - 1)),
          static_cast<float>(std::max(0.0, box.height - 1))};
}

Vector<2> foot_of(const Sample& sample) {
  return sample.box ? sample.box->foot() : Vector<2>(sample.position.head<2>());
}

Vector<2> centre_of(const Sample& sample) {
  return sample.outline ? sample.outline->centre : Vector<2>(sample.position.head<2>());
}

void draw_lines(Canvas& canvas, const Outline& outline, double unit) {
  constexpr Colour kLine{255, 255, 255};
  std::vector<Canvas::Stroke> lines;
  std::vector<cv::Point2f> crossings;
  for (const MeasurementLine& line : outline.lines) {
    const bool found = line.finding == MeasurementLine::Finding::found;
    lines.push_back(
        {to_point(line.foot - line.reach * line.normal), to_point(line.foot + line.reach * line.normal), found ? 0.55 : 0.25});
    if (found) crossings.push_back(to_point(line.foot + line.offset * line.normal));
  }
  canvas.strokes(lines, kLine, 1);
  canvas.discs(crossings, 0.8 * unit, kLine, 0.9);
}

void draw_curve(Canvas& canvas, const Outline& outline, const Colour& colour, double unit) {
  const std::vector<Vector<2>> corners = geometry::ClosedSpline(outline.order, outline.control_points).polygon();
  const bool seen = outline.state != Outline::State::held;
  std::vector<Canvas::Stroke> curve;
  for (std::size_t i = 0; i < corners.size(); ++i)
    curve.push_back({to_point(corners[i]), to_point(corners[(i + 1) % corners.size()]), seen ? 1.0 : 0.6});
  canvas.strokes(curve, colour, seen ? 1.4 * unit : 1);
  std::vector<cv::Point2f> points;
  for (const Vector<2>& point : outline.control_points) points.push_back(to_point(point));
  canvas.discs(points, 1.2 * unit, colour);
}

}  // namespace

Colour colour_of(const TrackName& name, TrackId id) {
  if (!name.colour) return colour_of(number(id));
  return {(*name.colour)[0], (*name.colour)[1], (*name.colour)[2]};
}

Picture Overlay::draw(const Picture& picture, Timestamp now, std::span<const Sample> samples, const TrackNames& names) {
  Canvas canvas(picture);
  // 2 px lines and numbers 11 px high in a picture of 576 rows; slower than the picture beyond, or they would hide people.
  const double unit = std::max(1.0, std::sqrt(picture.size().height / 576.0));
  for (const Sample& sample : samples) {
    const Vector<2> place = options_.trail_of_centres ? centre_of(sample) : foot_of(sample);
    trails_.add(number(sample.track), now, to_point(place), colour_of(names.of(sample.track), sample.track));
  }
  trails_.draw(canvas, now, 0.9, 2 * unit);

  for (const Sample& sample : samples) {
    if (sample.outline) {
      draw_lines(canvas, *sample.outline, unit);
      draw_curve(canvas, *sample.outline, colour_of(names.of(sample.track), sample.track), unit);
      continue;
    }
    if (!sample.box) continue;
    const bool seen = sample.measured();
    canvas.rectangle(edge_of(*sample.box), colour_of(names.of(sample.track), sample.track), seen ? 2 * unit : 1, seen ? 1.0 : 0.7);
  }
  for (const Sample& sample : samples) {
    const Vector<2> corner =
        sample.box ? Vector<2>(sample.box->left - unit, sample.box->top - unit) : Vector<2>(sample.position.head<2>());
    canvas.tag(names.shown(sample.track), to_point(corner), colour_of(names.of(sample.track), sample.track), 10 * unit);
  }
  return canvas.take();
}

}  // namespace marey::draw
