#include "marey/draw/pitch_view.h"

#include <cmath>

namespace marey::draw {
namespace {

constexpr Colour kGrass{52, 110, 58}, kStripe{57, 118, 63}, kLinePaint{235, 240, 235}, kInk{15, 15, 15};
constexpr double kStripeWidth = 5.25;  // m; twenty to the typical length
constexpr double kGrid = 5;            // m
constexpr double kDisc = 0.011;        // radius, of the image's width

cv::Mat plane(cv::Size size, double value) {
  return {size, CV_8UC1, cv::Scalar(value)};
}

/// Whether dark text is easier to read on it than white.
bool is_light(const Colour& colour) {
  return 0.299 * colour.red + 0.587 * colour.green + 0.114 * colour.blue > 140;
}

}  // namespace

PitchView::PitchView(const PitchViewOptions& options) : options_(options), trails_(options.trail) {
  const Vector<2> extent = options.high - options.low;
  scale_ = options.width / extent.x();
  const int height = std::max(2, static_cast<int>(std::lround(scale_ * extent.y() / 2)) * 2);
  const cv::Size size(options.width & ~1, height);
  ground_ = Image(plane(size, 0), plane(size / 2, 128), plane(size / 2, 128), Image::Range::limited);
  draw_ground();
}

cv::Point2f PitchView::pixel(const Vector<2>& location) const {
  const double across = (location.x() - options_.low.x()) * scale_;
  const double down = (options_.y_down ? location.y() - options_.low.y() : options_.high.y() - location.y()) * scale_;
  return {static_cast<float>(across - 0.5), static_cast<float>(down - 0.5)};
}

void PitchView::draw_ground() {
  Canvas canvas(ground_);
  const cv::Size size = ground_.size();
  canvas.fill({{}, cv::Size2f(size)}, kGrass);
  const double unit = std::max(1.0, size.width / 1280.0);
  std::vector<Canvas::Stroke> strokes;
  if (options_.pitch) {
    const geometry::PitchSize& pitch = *options_.pitch;
    for (double x = 0; x + kStripeWidth <= pitch.length + 1e-9; x += 2 * kStripeWidth)
      canvas.fill({pixel({x, 0}), pixel({x + kStripeWidth, pitch.width})}, kStripe);
    for (const geometry::PitchLine& line : geometry::pitch_lines(pitch, 0.1)) {
      for (std::size_t i = 1; i < line.points.size(); ++i) strokes.push_back({pixel(line.points[i - 1]), pixel(line.points[i])});
    }
    canvas.strokes(strokes, kLinePaint, 1.5 * unit);
  } else {
    for (double x = std::ceil(options_.low.x() / kGrid) * kGrid; x <= options_.high.x(); x += kGrid)
      strokes.push_back({pixel({x, options_.low.y()}), pixel({x, options_.high.y()}), 0.35});
    for (double y = std::ceil(options_.low.y() / kGrid) * kGrid; y <= options_.high.y(); y += kGrid)
      strokes.push_back({pixel({options_.low.x(), y}), pixel({options_.high.x(), y}), 0.35});
    canvas.strokes(strokes, kLinePaint, unit);
  }
  ground_ = canvas.take();
}

Image PitchView::draw(Timestamp now, std::span<const Mark> marks) {
  Canvas canvas(ground_);
  const double radius = kDisc * ground_.size().width;
  for (const Mark& mark : marks) trails_.add(mark.number, now, pixel(mark.location), mark.colour);
  trails_.draw(canvas, now, 0.8, 0.3 * radius);
  for (const Mark& mark : marks) {
    const cv::Point2f at = pixel(mark.location);
    canvas.discs({at}, radius, mark.observed ? kInk : mark.colour);
    canvas.discs({at}, 0.86 * radius, mark.observed ? mark.colour : kGrass);
    canvas.text(mark.text, at, is_light(mark.colour) && mark.observed ? kInk : kLinePaint, 0.85 * radius);
  }
  return canvas.take();
}

}  // namespace marey::draw
