#include "marey/draw/coverage_plot.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "marey/draw/svg.h"
#include "marey/geometry/median.h"

namespace marey::draw {
namespace {

constexpr int kColumns = 10, kRows = 8;
constexpr double kWidth = 900, kCoverageMargin = 20, kHead = 50;  // of the drawing
constexpr int kFull = 20;                                         // marks in a field from which it is darkest

/// How many times errors are magnified: a typical one becomes a hundredth of the image's width.
double magnification(const CoveragePlot& plot) {
  std::vector<double> sizes;
  for (const CoveragePlot::Mark& mark : plot.marks) {
    if (mark.used) sizes.push_back(mark.error.norm());
  }
  if (sizes.empty()) return 1;
  const double required = 0.01 * plot.size.width / std::max(1e-3, geometry::median(sizes));
  const double power = std::pow(10, std::floor(std::log10(required)));
  return std::max(1.0, (required >= 5 * power ? 5 : required >= 2 * power ? 2 : 1) * power);
}

void add_fields(Svg& svg, const CoveragePlot& plot, double scale) {
  std::array<int, static_cast<std::size_t>(kColumns * kRows)> count{};
  for (const CoveragePlot::Mark& mark : plot.marks) {
    if (!mark.used) continue;
    const int x = std::clamp(static_cast<int>((mark.pixel.x() + 0.5) / plot.size.width * kColumns), 0, kColumns - 1);
    const int y = std::clamp(static_cast<int>((mark.pixel.y() + 0.5) / plot.size.height * kRows), 0, kRows - 1);
    ++count[static_cast<std::size_t>(y * kColumns + x)];
  }
  const double width = scale * plot.size.width / kColumns, height = scale * plot.size.height / kRows;
  for (int y = 0; y < kRows; ++y) {
    for (int x = 0; x < kColumns; ++x) {
      const int marks = count[static_cast<std::size_t>(y * kColumns + x)];
      const double opacity = marks ? 0.08 + 0.3 * std::min(marks, kFull) / kFull : 1.0;
      svg.rect({kCoverageMargin + x * width, kHead + y * height, width, height},
               {{"fill", marks ? "#2a7de1" : "#fff"}, {"fill-opacity", fmt::format("{:.2f}", opacity)}, {"stroke", "#ddd"}});
    }
  }
}

}  // namespace

std::string to_svg(const CoveragePlot& plot) {
  const double scale = (kWidth - 2 * kCoverageMargin) / plot.size.width;
  const double height = kHead + scale * plot.size.height + kCoverageMargin;
  const double times = magnification(plot);
  Svg svg(kWidth, height, 12);
  svg.set({{"width", kWidth}, {"height", std::round(height)}});
  svg.text({kCoverageMargin, 22}, plot.title, {{"font-size", 16}});
  svg.text({kCoverageMargin, 41},
           fmt::format("errors drawn {:.0f} times as long as they are; red: not used; white fields: nothing was seen there", times),
           {{"fill", "#555"}});
  add_fields(svg, plot, scale);
  for (const CoveragePlot::Mark& mark : plot.marks) {
    const Vector<2> location = Vector<2>(kCoverageMargin, kHead) + scale * (mark.pixel + Vector<2>(0.5, 0.5));
    svg.circle(location, 1.4, {{"fill", mark.used ? "#123" : "#d22"}});
    if (mark.used) svg.line(location, location + scale * times * mark.error, {{"stroke", "#e07b00"}});
  }
  return svg.str();
}

}  // namespace marey::draw
