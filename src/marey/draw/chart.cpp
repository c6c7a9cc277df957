#include "marey/draw/chart.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "marey/draw/svg.h"

namespace marey::draw {
namespace {

constexpr double kMaxXTicks = 12;  // under a part of a page
constexpr double kHeight = 520, kLeft = 110, kTop = 44, kPlotHeight = 270, kBaseline = kTop + kPlotHeight;
// Okabe & Ito's colours, which the colour-blind distinguish as well.
constexpr std::array<const char*, 8> kColours{"#0072b2", "#e69f00", "#009e73", "#cc79a7",
                                              "#56b4e9", "#d55e00", "#999999", "#f0e442"};

/// Where a chart's plot is.
struct Plot {
  double left = kLeft, right = 0, top = kTop, height = kPlotHeight;
  double baseline() const { return top + height; }
};

/// A value axis from `low` to `high` in round steps.
struct Axis {
  double low = 0, high = 1;
  bool logarithmic = false;
  std::vector<double> ticks;
  Plot plot = {};

  double y(double value) const {
    const double fraction = logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
    return plot.baseline() - plot.height * std::clamp(fraction, 0.0, 1.0);
  }
};

Axis linear_axis(double high) {
  Axis axis;
  high = high > 0 ? high : 1;
  const double step = round_step(high / 4);
  axis.high = step * std::ceil(high / step - 1e-9);
  for (int i = 0; i * step <= axis.high * (1 + 1e-9); ++i) axis.ticks.push_back(i * step);
  return axis;
}

Axis logarithmic_axis(double low, double high) {
  Axis axis;
  axis.logarithmic = true;
  axis.low = std::pow(10, std::floor(std::log10(low)));
  axis.high = std::pow(10, std::max(std::ceil(std::log10(high)), std::log10(axis.low) + 1));
  for (double tick = axis.low; tick <= axis.high * 1.001; tick *= 10) axis.ticks.push_back(tick);
  return axis;
}

void add_frame(Svg& svg, double width, const std::string& title, const std::string& value_label, const Axis& axis) {
  svg.text({kLeft, 22}, title, {{"font-size", 15}, {"font-weight", "bold"}});
  svg.add("text", {{"transform", fmt::format("translate(52 {}) rotate(-90)", kTop + kPlotHeight / 2)}, {"text-anchor", "middle"}},
          value_label);
  for (const double tick : axis.ticks) {
    const double y = axis.y(tick);
    svg.line({kLeft, y}, {width - 20, y}, {{"stroke", "#ddd"}});
    svg.text({kLeft - 6, y + 4}, fmt::format("{:g}", tick), {{"text-anchor", "end"}});
  }
}

void add_legend(Svg& svg, double width, const std::vector<std::string>& names) {
  double x = kLeft, y = kBaseline + 112;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double advance = 30 + 7.2 * static_cast<double>(names[i].size());
    if (x + advance > width - 10 && x > kLeft) {
      x = kLeft;
      y += 18;
    }
    svg.rect({x, y, 11, 11}, {{"fill", line_colour(i)}});
    svg.text({x + 15, y + 10}, names[i]);
    x += advance;
  }
}

Axis value_axis(const LineChart& chart) {
  double low = HUGE_VAL, high = 0;
  for (const auto& line : chart.lines) {
    for (const auto& [x, y] : line.points) {
      low = std::min(low, y);
      high = std::max(high, y);
    }
  }
  if (low > high) low = high = 1;
  return chart.logarithmic_y ? logarithmic_axis(low, high) : linear_axis(high);
}

/// Where an x is drawn.
class XScale {
 public:
  XScale(const LineChart& chart, const Plot& plot) : plot_(plot) {
    for (const auto& line : chart.lines) {
      for (const auto& [x, y] : line.points) {
        minimum_ = std::min(minimum_, x);
        maximum_ = std::max(maximum_, x);
      }
    }
  }
  double minimum() const { return minimum_; }
  double maximum() const { return maximum_; }
  double operator()(double x) const {
    constexpr double indent = 10;
    return plot_.left + indent +
           (plot_.right - plot_.left - 2 * indent) * (maximum_ > minimum_ ? (x - minimum_) / (maximum_ - minimum_) : 0.5);
  }

 private:
  Plot plot_;
  double minimum_ = HUGE_VAL, maximum_ = -HUGE_VAL;
};

void add_lines(Svg& svg, const LineChart& chart, const Axis& axis, const XScale& scale) {
  for (std::size_t i = 0; i < chart.lines.size(); ++i) {
    std::vector<Vector<2>> points;
    for (const auto& [x, y] : chart.lines[i].points) points.emplace_back(scale(x), axis.y(y));
    svg.polyline(points,
                 {{"stroke", line_colour(i)}, {"stroke-width", 2}, {"stroke-dasharray", i < kColours.size() ? "none" : "6 3"}});
    for (std::size_t k = 0; k < points.size(); ++k) {
      const auto& [x, y] = chart.lines[i].points[k];
      svg.circle(points[k], 3, {{"fill", line_colour(i)}})
          .add("title", {}, fmt::format("{}: {:g}, {:g}", chart.lines[i].name, x, y));
    }
  }
}

}  // namespace

const char* line_colour(std::size_t index) {
  return kColours[index % kColours.size()];
}

std::string to_svg(const BarChart& chart) {
  constexpr double kBar = 14, kGap = 22;
  const double group_width = std::max(64.0, kBar * static_cast<double>(chart.series.size()) + kGap);
  double highest = 0;
  for (const auto& group : chart.groups) {
    for (const auto& bar : group.bars) {
      if (bar) highest = std::max({highest, bar->value, bar->high.value_or(0)});
    }
  }
  const Axis axis = linear_axis(highest);
  const double width = std::max(420.0, kLeft + 40 + group_width * static_cast<double>(chart.groups.size()));
  Svg svg(width, kHeight, 12);
  add_frame(svg, width, chart.title, chart.value_label, axis);
  for (std::size_t g = 0; g < chart.groups.size(); ++g) {
    const auto& group = chart.groups[g];
    const double left = kLeft + kGap / 2 + group_width * static_cast<double>(g);
    for (std::size_t s = 0; s < group.bars.size(); ++s) {
      if (!group.bars[s]) continue;
      const Bar& bar = *group.bars[s];
      const double x = left + kBar * static_cast<double>(s), y = axis.y(bar.value);
      svg.rect({x, y, kBar - 2, std::max(kBaseline - y, 0.5)}, {{"fill", line_colour(s)}})
          .add("title", {}, fmt::format("{}, {}: {:g}", group.name, chart.series[s], bar.value));
      if (bar.low && bar.high) {
        const double middle = x + kBar / 2 - 1;
        svg.line({middle, axis.y(*bar.low)}, {middle, axis.y(*bar.high)}, {{"stroke", "black"}});
      }
    }
    const double end = left + (group_width - kGap) / 2 + 8;
    svg.add("text", {{"transform", fmt::format("translate({:.1f} {}) rotate(-35)", end, kBaseline + 16)}, {"text-anchor", "end"}},
            group.name);
  }
  add_legend(svg, width, chart.series);
  return svg.str();
}

std::string to_svg(const LineChart& chart) {
  constexpr double kWidth = 760;
  Axis axis = value_axis(chart);
  axis.plot.right = kWidth - 30;
  Svg svg(kWidth, kHeight, 12);
  add_frame(svg, kWidth, chart.title, chart.y_label, axis);
  const XScale x(chart, axis.plot);
  add_lines(svg, chart, axis, x);
  if (!chart.lines.empty()) {
    for (const auto& [value, y] : chart.lines.front().points)
      svg.text({x(value), kBaseline + 18}, fmt::format("{:g}", value), {{"text-anchor", "middle"}});
  }
  svg.text({(kLeft + axis.plot.right) / 2, kBaseline + 38}, chart.x_label, {{"text-anchor", "middle"}});
  std::vector<std::string> names;
  for (const LineChart::Line& line : chart.lines) names.push_back(line.name);
  add_legend(svg, kWidth, names);
  return svg.str();
}

std::string part_svg(const LineChart& chart) {
  constexpr double kWidth = 480, kBelow = 40;
  Axis axis = value_axis(chart);
  axis.plot = {.left = 40, .right = kWidth - 8, .top = 12, .height = 210};
  Svg svg({{"viewBox", fmt::format("0 0 {} {}", kWidth, axis.plot.baseline() + kBelow)},
           {"font-family", "sans-serif"},
           {"font-size", 12}});
  for (const double tick : axis.ticks) {
    const double y = axis.y(tick);
    svg.line({axis.plot.left, y}, {axis.plot.right, y}, {{"class", "grid"}});
    svg.text({axis.plot.left - 5, y + 4}, fmt::format("{:g}", tick), {{"class", "axis"}, {"text-anchor", "end"}});
  }
  const XScale x(chart, axis.plot);
  add_lines(svg, chart, axis, x);
  const double step = std::ceil((x.maximum() - x.minimum() + 1) / kMaxXTicks);
  for (double value = x.minimum(); value <= x.maximum(); value += step)
    svg.text({x(value), axis.plot.baseline() + 17}, fmt::format("{:g}", value), {{"class", "axis"}, {"text-anchor", "middle"}});
  svg.text({(axis.plot.left + axis.plot.right) / 2, axis.plot.baseline() + 34}, chart.x_label,
           {{"class", "axis"}, {"text-anchor", "middle"}});
  return svg.str();
}

}  // namespace marey::draw
