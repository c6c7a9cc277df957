#include "marey/draw/coverage_plot.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "marey/draw/svg_text.h"

namespace marey::draw {
namespace {

constexpr int kColumns = 10, kRows = 8;
constexpr double kWidth = 900, kCoverageMargin = 20, kHead = 50;  // of the drawing
constexpr int kFull = 20;                                         // marks in a field from which it is darkest

/// How many times errors are magnified: a typical one becomes a hundredth of the picture's width.
double magnification(const CoveragePlot& plot) {
  std::vector<double> sizes;
  for (const CoveragePlot::Mark& mark : plot.marks) {
    if (mark.used) sizes.push_back(mark.error.norm());
  }
  if (sizes.empty()) return 1;
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  const double wanted = 0.01 * plot.size.width / std::max(1e-3, *middle);
  const double power = std::pow(10, std::floor(std::log10(wanted)));
  return std::max(1.0, (wanted >= 5 * power ? 5 : wanted >= 2 * power ? 2 : 1) * power);
}

std::string fields(const CoveragePlot& plot, double scale) {
  std::array<int, static_cast<std::size_t>(kColumns * kRows)> count{};
  for (const CoveragePlot::Mark& mark : plot.marks) {
    if (!mark.used) continue;
    const int x = std::clamp(static_cast<int>((mark.pixel.x() + 0.5) / plot.size.width * kColumns), 0, kColumns - 1);
    const int y = std::clamp(static_cast<int>((mark.pixel.y() + 0.5) / plot.size.height * kRows), 0, kRows - 1);
    ++count[static_cast<std::size_t>(y * kColumns + x)];
  }
  std::string svg;
  const double width = scale * plot.size.width / kColumns, height = scale * plot.size.height / kRows;
  for (int y = 0; y < kRows; ++y) {
    for (int x = 0; x < kColumns; ++x) {
      const int marks = count[static_cast<std::size_t>(y * kColumns + x)];
      svg += fmt::format(
          "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\" fill-opacity=\"{:.2f}\" "
          "stroke=\"#ddd\"/>\n",
          kCoverageMargin + x * width, kHead + y * height, width, height, marks ? "#2a7de1" : "#fff",
          marks ? 0.08 + 0.3 * std::min(marks, kFull) / kFull : 1.0);
    }
  }
  return svg;
}

}  // namespace

std::string to_svg(const CoveragePlot& plot) {
  const double scale = (kWidth - 2 * kCoverageMargin) / plot.size.width;
  const double height = kHead + scale * plot.size.height + kCoverageMargin;
  const double times = magnification(plot);
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "font-family=\"sans-serif\">\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n<text x=\"{2}\" y=\"22\" font-size=\"16\">{3}</text>\n"
      "<text x=\"{2}\" y=\"41\" font-size=\"12\" fill=\"#555\">errors drawn {4:.0f} times as long as they are; red: not used; "
      "white fields: nothing was seen there</text>\n",
      kWidth, height, kCoverageMargin, escaped(plot.title), times);
  svg += fields(plot, scale);
  for (const CoveragePlot::Mark& mark : plot.marks) {
    const double x = kCoverageMargin + scale * (mark.pixel.x() + 0.5), y = kHead + scale * (mark.pixel.y() + 0.5);
    const Vector<2> end = Vector<2>(x, y) + scale * times * mark.error;
    const char* colour = mark.used ? "#123" : "#d22";
    svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"1.4\" fill=\"{}\"/>", x, y, colour);
    if (mark.used) svg += fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"#e07b00\"/>", x, y, end.x(), end.y());
    svg += '\n';
  }
  return svg + "</svg>\n";
}

}  // namespace marey::draw
