#include "marey/draw/trajectory_plot.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "marey/core/geometry.h"
#include "marey/draw/canvas.h"
#include "marey/draw/svg_text.h"

namespace marey::draw {
namespace {

constexpr double kShortest = 0.5;     // px; a step
constexpr double kLongestSide = 900;  // units of the picture
constexpr double kLeastSpan = 20;     // px shown at least, where nobody moves
constexpr double kPlotMargin = 56, kPlotTop = 40, kPlotBottom = 48;

double round_step(double span) {
  const double magnitude = std::pow(10, std::floor(std::log10(span / 5)));
  const double ratio = span / 5 / magnitude;
  return magnitude * (ratio <= 1 ? 1 : ratio <= 2 ? 2 : ratio <= 5 ? 5 : 10);
}

/// The part of the image that is shown: what the ways span, and a twentieth more on each side.
Box window_of(const Vector<2>& low, const Vector<2>& high) {
  const Vector<2> middle = (low + high) / 2;
  const Vector<2> span = (1.1 * (high - low)).cwiseMax(kLeastSpan);
  return {middle.x() - span.x() / 2, middle.y() - span.y() / 2, span.x(), span.y()};
}

class PlotPage {
 public:
  explicit PlotPage(const Box& window) : window_(window), scale_(kLongestSide / std::max(window.width, window.height)) {
    add(R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {:.0f} {:.0f}" font-family="sans-serif" font-size="12">)",
        scale_ * window.width + kPlotMargin + 20, scale_ * window.height + kPlotTop + kPlotBottom);
    add(R"(<rect width="100%" height="100%" fill="white"/>)");
  }

  template <typename... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    text_ += '\n';
  }

  double x(double column) const { return kPlotMargin + scale_ * (column - window_.left); }
  double y(double row) const { return kPlotTop + scale_ * (row - window_.top); }

  void axes(const std::string& title) {
    add(R"(<text x="{}" y="22" font-size="15" font-weight="bold">{}</text>)", kPlotMargin, escaped(title));
    const double bottom = y(window_.bottom());
    for (const double tick : ticks(window_.left, window_.right())) {
      add(R"(<line x1="{0:.1f}" x2="{0:.1f}" y1="{1}" y2="{2:.1f}" stroke="#ddd"/>)", x(tick), kPlotTop, bottom);
      add(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="middle">{:g}</text>)", x(tick), bottom + 16, tick);
    }
    for (const double tick : ticks(window_.top, window_.bottom())) {
      add(R"(<line x1="{0}" x2="{1:.1f}" y1="{2:.1f}" y2="{2:.1f}" stroke="#ddd"/>)", kPlotMargin, x(window_.right()), y(tick));
      add(R"(<text x="{}" y="{:.1f}" text-anchor="end">{:g}</text>)", kPlotMargin - 6, y(tick) + 4, tick);
    }
    add(R"(<rect x="{}" y="{}" width="{:.1f}" height="{:.1f}" fill="none" stroke="#888"/>)", kPlotMargin, kPlotTop,
        scale_ * window_.width, scale_ * window_.height);
    add(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="middle">x, px</text>)", x(window_.left + window_.width / 2), bottom + 36);
    add(R"svg(<text transform="translate(14 {:.1f}) rotate(-90)" text-anchor="middle">y, px (down)</text>)svg",
        y(window_.top + window_.height / 2));
  }

  std::string finish() && { return std::move(text_) + "</svg>\n"; }

 private:
  static std::vector<double> ticks(double from, double to) {
    std::vector<double> result;
    const double step = round_step(to - from);
    for (double i = std::ceil(from / step); i * step <= to; ++i) result.push_back(i * step);
    return result;
  }

  Box window_;
  double scale_;
  std::string text_;
};

std::string css(const Colour& colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour.red * 3 / 4, colour.green * 3 / 4, colour.blue * 3 / 4);  // dark, on white
}

}  // namespace

void TrajectoryPlot::add(const Instant& instant) {
  names_.add(instant.named);
  for (const Sample& sample : instant.samples) {
    const Vector<2> place = sample.outline ? sample.outline->centre : Vector<2>(sample.position.head<2>());
    Way& way = ways_[sample.track];
    if (way.pieces.empty() || way.last_frame + 1 != instant.index) {
      if (!way.pieces.empty() && way.pieces.back().back() != way.last) way.pieces.back().push_back(way.last);
      way.pieces.push_back({place});
      way.name = names_.shown(sample.track);
    } else if ((place - way.pieces.back().back()).norm() >= kShortest) {
      way.pieces.back().push_back(place);
    }
    way.last = place;
    way.last_frame = instant.index;
  }
}

std::string TrajectoryPlot::to_svg(const std::string& title) const {
  Vector<2> low(HUGE_VAL, HUGE_VAL), high(-HUGE_VAL, -HUGE_VAL);
  for (const auto& [id, way] : ways_) {
    for (const auto& piece : way.pieces) {
      for (const Vector<2>& place : piece) {
        low = low.cwiseMin(place);
        high = high.cwiseMax(place);
      }
    }
  }
  if (ways_.empty()) low = high = Vector<2>::Zero();
  PlotPage page(window_of(low, high));
  page.axes(title);
  for (const auto& [id, way] : ways_) {
    const std::string colour = css(colour_of(number(id)));
    for (std::size_t i = 0; i < way.pieces.size(); ++i) {
      std::string points;
      for (const Vector<2>& place : way.pieces[i])
        fmt::format_to(std::back_inserter(points), "{:.1f},{:.1f} ", page.x(place.x()), page.y(place.y()));
      if (i + 1 == way.pieces.size() && way.pieces[i].back() != way.last)
        fmt::format_to(std::back_inserter(points), "{:.1f},{:.1f}", page.x(way.last.x()), page.y(way.last.y()));
      page.add(R"(<polyline points="{}" fill="none" stroke="{}" stroke-width="1.6" stroke-linejoin="round"/>)", points, colour);
    }
    const Vector<2>& begin = way.pieces.front().front();
    page.add(R"(<circle cx="{:.1f}" cy="{:.1f}" r="3" fill="{}"/>)", page.x(begin.x()), page.y(begin.y()), colour);
    page.add(R"(<text x="{:.1f}" y="{:.1f}" fill="{}">{}</text>)", page.x(begin.x()) + 5, page.y(begin.y()) - 4, colour,
             escaped(way.name));
  }
  return std::move(page).finish();
}

}  // namespace marey::draw
