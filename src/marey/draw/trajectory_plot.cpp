#include "marey/draw/trajectory_plot.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "marey/core/geometry.h"
#include "marey/draw/canvas.h"
#include "marey/draw/svg.h"

namespace marey::draw {
namespace {

constexpr double kMinLength = 0.5;      // px; a step
constexpr double kMaxSideLength = 900;  // units of the image
constexpr double kMinSpan = 20;         // px shown at least, if nothing moves
constexpr double kPlotMargin = 56, kPlotTop = 40, kPlotBottom = 48;

/// The part of the image that is shown: what the trajectories span, and a twentieth more on each side.
Box window_of(const Vector<2>& low, const Vector<2>& high) {
  const Vector<2> middle = (low + high) / 2;
  const Vector<2> span = (1.1 * (high - low)).cwiseMax(kMinSpan);
  return {middle.x() - span.x() / 2, middle.y() - span.y() / 2, span.x(), span.y()};
}

class PlotPage : public Svg {
 public:
  explicit PlotPage(const Box& window) : PlotPage(window, kMaxSideLength / std::max(window.width, window.height)) {}

  /// Where a pixel is drawn.
  Vector<2> location(const Vector<2>& pixel) const {
    return Vector<2>(kPlotMargin, kPlotTop) + scale_ * (pixel - Vector<2>(window_.left, window_.top));
  }

  void axes(const std::string& title) {
    text({kPlotMargin, 22}, title, {{"font-size", 15}, {"font-weight", "bold"}});
    const Vector<2> end = location({window_.right(), window_.bottom()});
    for (const double tick : ticks(window_.left, window_.right())) {
      const double x = location({tick, 0}).x();
      line({x, kPlotTop}, {x, end.y()}, {{"stroke", "#ddd"}});
      text({x, end.y() + 16}, fmt::format("{:g}", tick), {{"text-anchor", "middle"}});
    }
    for (const double tick : ticks(window_.top, window_.bottom())) {
      const double y = location({0, tick}).y();
      line({kPlotMargin, y}, {end.x(), y}, {{"stroke", "#ddd"}});
      text({kPlotMargin - 6, y + 4}, fmt::format("{:g}", tick), {{"text-anchor", "end"}});
    }
    rect({kPlotMargin, kPlotTop, scale_ * window_.width, scale_ * window_.height}, {{"fill", "none"}, {"stroke", "#888"}});
    const Vector<2> middle = location({window_.left + window_.width / 2, window_.top + window_.height / 2});
    text({middle.x(), end.y() + 36}, "x, px", {{"text-anchor", "middle"}});
    add("text", {{"transform", fmt::format("translate(14 {:.1f}) rotate(-90)", middle.y())}, {"text-anchor", "middle"}},
        "y, px (down)");
  }

 private:
  PlotPage(const Box& window, double scale)
      : Svg(scale * window.width + kPlotMargin + 20, scale * window.height + kPlotTop + kPlotBottom, 12),
        window_(window),
        scale_(scale) {}

  static std::vector<double> ticks(double from, double to) {
    std::vector<double> result;
    const double step = round_step((to - from) / 5);
    for (double i = std::ceil(from / step); i * step <= to; ++i) result.push_back(i * step + 0.0);  // without -0
    return result;
  }

  Box window_;
  double scale_;
};

std::string css(const Colour& colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour.red * 3 / 4, colour.green * 3 / 4, colour.blue * 3 / 4);  // dark, on white
}

}  // namespace

void TrajectoryPlot::add(const Instant& instant) {
  names_.add(instant.named);
  for (const Sample& sample : instant.samples) {
    const Vector<2> location = sample.outline ? sample.outline->centre : Vector<2>(sample.position.head<2>());
    Trajectory& trajectory = trajectories_[sample.track];
    if (trajectory.pieces.empty() || trajectory.last_frame + 1 != instant.index) {
      if (!trajectory.pieces.empty() && trajectory.pieces.back().back() != trajectory.last)
        trajectory.pieces.back().push_back(trajectory.last);
      trajectory.pieces.push_back({location});
      trajectory.name = names_.shown(sample.track);
    } else if ((location - trajectory.pieces.back().back()).norm() >= kMinLength) {
      trajectory.pieces.back().push_back(location);
    }
    trajectory.last = location;
    trajectory.last_frame = instant.index;
  }
}

std::string TrajectoryPlot::to_svg(const std::string& title) const {
  Vector<2> low(HUGE_VAL, HUGE_VAL), high(-HUGE_VAL, -HUGE_VAL);
  for (const auto& [id, trajectory] : trajectories_) {
    for (const auto& piece : trajectory.pieces) {
      for (const Vector<2>& location : piece) {
        low = low.cwiseMin(location);
        high = high.cwiseMax(location);
      }
    }
  }
  if (trajectories_.empty()) low = high = Vector<2>::Zero();
  PlotPage page(window_of(low, high));
  page.axes(title);
  for (const auto& [id, trajectory] : trajectories_) {
    const std::string colour = css(colour_of(number(id)));
    for (std::size_t i = 0; i < trajectory.pieces.size(); ++i) {
      std::vector<Vector<2>> points;
      for (const Vector<2>& pixel : trajectory.pieces[i]) points.push_back(page.location(pixel));
      if (i + 1 == trajectory.pieces.size() && trajectory.pieces[i].back() != trajectory.last)
        points.push_back(page.location(trajectory.last));
      page.polyline(points, {{"stroke", colour}, {"stroke-width", 1.6}, {"stroke-linejoin", "round"}});
    }
    const Vector<2> begin = page.location(trajectory.pieces.front().front());
    page.circle(begin, 3, {{"fill", colour}});
    page.text(begin + Vector<2>(5, -4), trajectory.name, {{"fill", colour}});
  }
  return page.str();
}

}  // namespace marey::draw
