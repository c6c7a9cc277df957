#include "marey/draw/overlay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
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

/// The curve in pieces: dashed where the edge is not seen.
std::vector<Canvas::Stroke> strokes_of(const Outline& outline, double opacity, double unit) {
  constexpr int kPieces = 8;     // a control point
  constexpr double kDash = 3.5;  // units: as long as the gap after it
  const std::vector<Vector<2>> corners = geometry::ClosedSpline(outline.order, outline.control_points).polygon(kPieces);
  const std::size_t count = outline.control_points.size();
  std::vector<char> hidden(count, 0);
  for (const int point : outline.hidden) hidden[static_cast<std::size_t>(point)] = 1;
  std::vector<Canvas::Stroke> curve;
  double length = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector<2>&from = corners[i], &to = corners[(i + 1) % corners.size()];
    const bool is_hidden = hidden[((i + kPieces / 2) / kPieces) % count] != 0;
    if (!is_hidden || std::fmod(length, 2 * kDash * unit) < kDash * unit) curve.push_back({to_point(from), to_point(to), opacity});
    length = is_hidden ? length + (to - from).norm() : 0;
  }
  return curve;
}

void draw_curve(Canvas& canvas, const Outline& outline, const Colour& colour, double unit) {
  const bool detected = outline.state != Outline::State::held;
  const std::vector<Canvas::Stroke> curve = strokes_of(outline, detected ? 1.0 : 0.6, unit);
  canvas.strokes(curve, colour, detected ? 1.4 * unit : 1);
  std::vector<cv::Point2f> points;
  for (const Vector<2>& point : outline.control_points) points.push_back(to_point(point));
  canvas.discs(points, 1.2 * unit, colour);
}

/// Towards white, for what is on a person's left.
Colour lighter(const Colour& colour) {
  const auto half = [](unsigned char value) { return static_cast<unsigned char>((value + 3 * 255) / 4); };
  return {half(colour.red), half(colour.green), half(colour.blue)};
}

void draw_body(Canvas& canvas, const Keypoints<2>& body, const KeypointSet& set, const Colour& colour, double unit) {
  constexpr double kWithin = 0.5, kFaintest = 0.25;
  const auto shown = [&](int point) {
    const auto i = static_cast<std::size_t>(point);
    return i < body.points.size() && body.points[i] && body.points[i]->presence >= kWithin ? &*body.points[i] : nullptr;
  };
  const auto is_left = [&](int point) { return set.points[static_cast<std::size_t>(point)].starts_with("left_"); };
  std::array<std::vector<Canvas::Stroke>, 2> bones;  // to the right and in the middle, to the left
  std::array<std::vector<cv::Point2f>, 2> joints;
  for (const auto& [a, b] : set.bones) {
    const Keypoint<2>*from = shown(a), *to = shown(b);
    if (from == nullptr || to == nullptr) continue;
    const double detected = std::min(from->visibility, to->visibility);
    bones[is_left(a) && is_left(b)].push_back(
        {to_point(from->position), to_point(to->position), kFaintest + (1 - kFaintest) * detected});
  }
  for (int i = 0; i < static_cast<int>(std::min(set.points.size(), body.points.size())); ++i) {
    if (const Keypoint<2>* point = shown(i); point != nullptr && point->visibility >= kWithin)
      joints[is_left(i)].push_back(to_point(point->position));
  }
  for (std::size_t left = 0; left < 2; ++left) {
    const Colour own = left == 1 ? lighter(colour) : colour;
    canvas.strokes(bones[left], own, 1.6 * unit);
    canvas.discs(joints[left], 1.6 * unit, own);
  }
}

constexpr std::size_t kMaxLocatedNames = 300;  // of an image; the search for room grows with their square

/// What a name is not to cover: a target's box, or what is round its point.
cv::Rect2d body_of(const Sample& sample, double unit) {
  if (sample.box) return {sample.box->left, sample.box->top, sample.box->width, sample.box->height};
  const double radius = 4 * unit;
  return {sample.position.x() - radius, sample.position.y() - radius, 2 * radius, 2 * radius};
}

/// The bottom left corners that a name of this size may have: above a box's left edge, or round a point, ever further away.
std::vector<cv::Point2f> corners_of(const Sample& sample, const cv::Size& size, double unit) {
  const cv::Rect2d body = body_of(sample, unit);
  std::vector<cv::Point2f> corners;
  for (const double gap : {1.0, 12.0, 26.0}) {
    const double left = body.x - gap * unit - size.width, right = body.br().x + gap * unit;
    const double above = body.y - gap * unit, below = body.br().y + gap * unit + size.height;
    if (sample.box) corners.emplace_back(body.x - unit, above);
    for (const double y : {above, below}) {
      for (const double x : {right, left}) corners.emplace_back(x, y);
    }
    const double middle = body.x + (body.width - size.width) / 2;
    corners.emplace_back(middle, above);
    corners.emplace_back(middle, below);
  }
  return corners;
}

}  // namespace

Colour colour_of(const TrackName& name, TrackId id) {
  if (!name.colour) return colour_of(number(id));
  return {(*name.colour)[0], (*name.colour)[1], (*name.colour)[2]};
}

/// Cameras of 10 or 12 bits write images of 16, of which they fill the darkest part alone: white is the lightest that this many
/// bits hold as the images have shown until now, so that it barely ever changes.
Image Overlay::lightened(const Image& image) {
  if (image.luma().depth() != CV_16U) return image;
  const double maximum = lightest(image);
  while (white_ < maximum) white_ = 2 * white_ + 1;
  return with_white(image, white_);
}

Image Overlay::draw(const Image& image, Timestamp now, std::span<const Sample> samples, const TrackNames& names,
                    std::span<const cv::Rect2f> blurred) {
  Canvas canvas(lightened(image));
  for (const cv::Rect2f& part : blurred) canvas.coarsen(part);
  if (options_.bare) return canvas.take();
  // 2 px lines and numbers 11 px high in an image of 576 rows; slower than the image beyond, or they would hide people.
  const double unit = std::max(1.0, std::sqrt(image.size().height / 576.0));
  for (const Sample& sample : samples) {
    const Vector<2> location = options_.trail_of_centres ? centre_of(sample) : foot_of(sample);
    trails_.add(number(sample.track), now, to_point(location), colour_of(names.of(sample.track), sample.track));
  }
  trails_.draw(canvas, now, 0.9, 2 * unit);
  draw_targets(canvas, samples, names, unit);
  write_names(canvas, samples, names, unit);
  return canvas.take();
}

void Overlay::draw_targets(Canvas& canvas, std::span<const Sample> samples, const TrackNames& names, double unit) {
  for (const Sample& sample : samples) {
    if (sample.outline) {
      draw_lines(canvas, *sample.outline, unit);
      draw_curve(canvas, *sample.outline, colour_of(names.of(sample.track), sample.track), unit);
      continue;
    }
    const Colour colour = colour_of(names.of(sample.track), sample.track);
    const bool has_body = sample.keypoints && options_.keypoints;
    if (has_body) draw_body(canvas, *sample.keypoints, *options_.keypoints, colour, unit);
    if (!sample.box) continue;
    const bool detected = sample.measured() && !has_body;
    canvas.rectangle(edge_of(*sample.box), colour, detected ? 2 * unit : 1, detected ? 1.0 : 0.7);
  }
}

void Overlay::write_names(Canvas& canvas, std::span<const Sample> samples, const TrackNames& names, double unit) {
  const double height = 10 * unit;
  std::vector<cv::Rect2d> taken;  // first by the targets, in their order, then by names
  for (const Sample& sample : samples) taken.push_back(body_of(sample, unit));
  std::map<TrackId, std::size_t> sides;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::string text = names.shown(samples[i].track);
    const std::vector<cv::Point2f> corners = corners_of(samples[i], canvas.tag_area(text, {0, 0}, height).size(), unit);
    const auto covered = [&](std::size_t side) {
      const cv::Rect2d area = canvas.tag_area(text, corners[side], height);
      double sum = 0;
      for (std::size_t other = 0; other < taken.size(); ++other)
        sum += other == i && samples[i].box ? 0 : (area & taken[other]).area();
      return sum;
    };
    const auto before = sides_.find(samples[i].track);
    std::size_t best = before != sides_.end() && before->second < corners.size() ? before->second : 0;
    double minimum = covered(best);
    for (std::size_t side = 0; side < corners.size() && minimum > 0 && samples.size() <= kMaxLocatedNames; ++side) {
      if (const double area = covered(side); area < minimum) best = side, minimum = area;
    }
    canvas.tag(text, corners[best], colour_of(names.of(samples[i].track), samples[i].track), height);
    taken.emplace_back(canvas.tag_area(text, corners[best], height));
    sides.emplace(samples[i].track, best);
  }
  sides_ = std::move(sides);
}

}  // namespace marey::draw
