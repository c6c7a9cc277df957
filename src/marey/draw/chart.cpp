#include "marey/draw/chart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "marey/draw/svg_text.h"

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
  const double magnitude = std::pow(10, std::floor(std::log10(high / 4)));
  const double ratio = high / 4 / magnitude;
  const double step = magnitude * (ratio <= 1 ? 1 : ratio <= 2 ? 2 : ratio <= 5 ? 5 : 10);
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

class Svg {
 public:
  explicit Svg(double width) : width_(width) {
    add(R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {} {}" font-family="sans-serif" font-size="12">)", width, kHeight);
    add(R"(<rect width="100%" height="100%" fill="white"/>)");
  }

  template <typename... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    text_ += '\n';
  }

  void frame(const std::string& title, const std::string& value_label, const Axis& axis) {
    add(R"(<text x="{}" y="22" font-size="15" font-weight="bold">{}</text>)", kLeft, escaped(title));
    add(R"svg(<text transform="translate(52 {}) rotate(-90)" text-anchor="middle">{}</text>)svg", kTop + kPlotHeight / 2,
        escaped(value_label));
    for (const double tick : axis.ticks) {
      const double y = axis.y(tick);
      add(R"(<line x1="{}" x2="{}" y1="{:.1f}" y2="{:.1f}" stroke="#ddd"/>)", kLeft, width_ - 20, y, y);
      add(R"(<text x="{}" y="{:.1f}" text-anchor="end">{:g}</text>)", kLeft - 6, y + 4, tick);
    }
  }

  void legend(const std::vector<std::string>& names) {
    double x = kLeft, y = kBaseline + 112;
    for (std::size_t i = 0; i < names.size(); ++i) {
      const double width = 30 + 7.2 * static_cast<double>(names[i].size());
      if (x + width > width_ - 10 && x > kLeft) {
        x = kLeft;
        y += 18;
      }
      add(R"(<rect x="{:.1f}" y="{:.1f}" width="11" height="11" fill="{}"/>)", x, y, colour(i));
      add(R"(<text x="{:.1f}" y="{:.1f}">{}</text>)", x + 15, y + 10, escaped(names[i]));
      x += width;
    }
  }

  std::string finish() && { return std::move(text_) + "</svg>\n"; }

 private:
  double width_;
  std::string text_;
};

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
  Svg svg(std::max(420.0, kLeft + 40 + group_width * static_cast<double>(chart.groups.size())));
  svg.frame(chart.title, chart.value_label, axis);
  for (std::size_t g = 0; g < chart.groups.size(); ++g) {
    const auto& group = chart.groups[g];
    const double left = kLeft + kGap / 2 + group_width * static_cast<double>(g);
    for (std::size_t s = 0; s < group.bars.size(); ++s) {
      if (!group.bars[s]) continue;
      const Bar& bar = *group.bars[s];
      const double x = left + kBar * static_cast<double>(s), y = axis.y(bar.value);
      svg.add(R"(<rect x="{:.1f}" y="{:.1f}" width="{}" height="{:.1f}" fill="{}"><title>{}, {}: {:g}</title></rect>)", x, y,
              kBar - 2, std::max(kBaseline - y, 0.5), colour(s), escaped(group.name), escaped(chart.series[s]), bar.value);
      if (bar.low && bar.high) {
        svg.add(R"(<line x1="{0:.1f}" x2="{0:.1f}" y1="{1:.1f}" y2="{2:.1f}" stroke="black"/>)", x + kBar / 2 - 1, axis.y(*bar.low),
                axis.y(*bar.high));
      }
    }
    const double middle = left + (group_width - kGap) / 2;
    svg.add(R"svg(<text transform="translate({:.1f} {}) rotate(-35)" text-anchor="end">{}</text>)svg", middle + 8, kBaseline + 16,
            escaped(group.name));
  }
  svg.legend(chart.series);
  return std::move(svg).finish();
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
  Svg svg(kWidth);
  svg.frame(chart.title, chart.y_label, axis);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < chart.lines.size(); ++i) {
    std::string points;
    for (const auto& [x, y] : chart.lines[i].points)
      fmt::format_to(std::back_inserter(points), "{:.1f},{:.1f} ", place(x), axis.y(y));
    svg.add(R"(<polyline points="{}" fill="none" stroke="{}" stroke-width="2"{}/>)", points, colour(i),
            i < kColours.size() ? "" : R"( stroke-dasharray="6 3")");
    for (const auto& [x, y] : chart.lines[i].points) {
      svg.add(R"(<circle cx="{:.1f}" cy="{:.1f}" r="3" fill="{}"><title>{}: {:g}, {:g}</title></circle>)", place(x), axis.y(y),
              colour(i), escaped(chart.lines[i].name), x, y);
    }
    names.push_back(chart.lines[i].name);
  }
  if (!chart.lines.empty()) {
    for (const auto& [x, y] : chart.lines.front().points) {
      svg.add(R"(<text x="{:.1f}" y="{}" text-anchor="middle">{:g}</text>)", place(x), kBaseline + 18, x);
    }
  }
  svg.add(R"(<text x="{}" y="{}" text-anchor="middle">{}</text>)", (kLeft + kRight) / 2, kBaseline + 38, escaped(chart.x_label));
  svg.legend(names);
  return std::move(svg).finish();
}

}  // namespace marey::draw
