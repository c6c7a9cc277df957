#include "marey/draw/chart.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "marey/draw/svg.h"

namespace marey::draw {
namespace {

constexpr double kHeight = 520, kLeft = 110, kTop = 44, kPlotHeight = 270, kBaseline = kTop + kPlotHeight;
// Okabe & Ito's colours, which the colour-blind tell apart as well.
constexpr std::array<const char*, 8> kColours{"#0072b2", "#e69f00", "#009e73", "#cc79a7",
                                              "#56b4e9", "#d55e00", "#999999", "#f0e442"};

const char* colour(std::size_t index) {
  return kColours[index % kColours.size()];
}

/// A value axis from `low` to `high` in round steps.
struct Axis {
  double low = 0, high = 1;
  bool logarithmic = false;
  std::vector<double> ticks;

  double y(double value) const {
    const double share = logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
    return kBaseline - kPlotHeight * std::clamp(share, 0.0, 1.0);
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
    svg.rect({x, y, 11, 11}, {{"fill", colour(i)}});
    svg.text({x + 15, y + 10}, names[i]);
    x += advance;
  }
}

}  // namespace

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
      svg.rect({x, y, kBar - 2, std::max(kBaseline - y, 0.5)}, {{"fill", colour(s)}})
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
  constexpr double kWidth = 760, kRight = kWidth - 30;
  double low = HUGE_VAL, high = 0, left = HUGE_VAL, right = -HUGE_VAL;
  for (const auto& line : chart.lines) {
    for (const auto& [x, y] : line.points) {
      low = std::min(low, y);
      high = std::max(high, y);
      left = std::min(left, x);
      right = std::max(right, x);
    }
  }
  if (left > right) left = right = low = high = 1;
  const Axis axis = chart.logarithmic_y ? logarithmic_axis(low, high) : linear_axis(high);
  const auto place = [&](double x) {
    return kLeft + 10 + (kRight - kLeft - 20) * (right > left ? (x - left) / (right - left) : 0.5);
  };
  Svg svg(kWidth, kHeight, 12);
  add_frame(svg, kWidth, chart.title, chart.y_label, axis);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < chart.lines.size(); ++i) {
    std::vector<Vector<2>> points;
    for (const auto& [x, y] : chart.lines[i].points) points.emplace_back(place(x), axis.y(y));
    svg.polyline(points, {{"stroke", colour(i)}, {"stroke-width", 2}, {"stroke-dasharray", i < kColours.size() ? "none" : "6 3"}});
    for (std::size_t k = 0; k < points.size(); ++k) {
      const auto& [x, y] = chart.lines[i].points[k];
      svg.circle(points[k], 3, {{"fill", colour(i)}}).add("title", {}, fmt::format("{}: {:g}, {:g}", chart.lines[i].name, x, y));
    }
    names.push_back(chart.lines[i].name);
  }
  if (!chart.lines.empty()) {
    for (const auto& [x, y] : chart.lines.front().points)
      svg.text({place(x), kBaseline + 18}, fmt::format("{:g}", x), {{"text-anchor", "middle"}});
  }
  svg.text({(kLeft + kRight) / 2, kBaseline + 38}, chart.x_label, {{"text-anchor", "middle"}});
  add_legend(svg, kWidth, names);
  return svg.str();
}

}  // namespace marey::draw
