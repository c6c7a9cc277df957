#include "marey/draw/gait_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "marey/draw/page.h"
#include "marey/draw/svg.h"

namespace marey::draw {
namespace {

constexpr double kPanelWidth = 300, kPanelHeight = 190, kPanelLeft = 44, kPanelTop = 26, kPanelBottom = 28, kPanelRight = 8;
constexpr const char* kLeftColour = "#c0392b";
constexpr const char* kRightColour = "#1f77b4";

struct PanelScale {
  double low = 0, high = 1;
  std::size_t points = 1;
  double x(std::size_t i) const {
    return kPanelLeft + (kPanelWidth - kPanelLeft - kPanelRight) * static_cast<double>(i) /
                            static_cast<double>(std::max<std::size_t>(points, 2) - 1);
  }
  double y(double value) const {
    return kPanelHeight - kPanelBottom - (kPanelHeight - kPanelTop - kPanelBottom) * (value - low) / (high - low);
  }
};

void add_band(Svg& svg, const std::vector<std::pair<double, double>>& curve, const PanelScale& scale, const char* colour) {
  if (curve.empty()) return;
  std::vector<Vector<2>> band, middle;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    middle.emplace_back(scale.x(i), scale.y(curve[i].first));
    band.emplace_back(scale.x(i), scale.y(curve[i].first + curve[i].second));
  }
  for (std::size_t i = curve.size(); i-- > 0;) band.emplace_back(scale.x(i), scale.y(curve[i].first - curve[i].second));
  svg.polygon(band, {{"fill", colour}, {"fill-opacity", "0.18"}});
  svg.polyline(middle, {{"stroke", colour}, {"stroke-width", 1.6}});
}

std::string panel_svg(const GaitReport::Panel& panel) {
  PanelScale scale{.low = 1e9, .high = -1e9, .points = std::max(panel.left.size(), panel.right.size())};
  for (const auto* curve : {&panel.left, &panel.right}) {
    for (const auto& [mean, deviation] : *curve) {
      scale.low = std::min(scale.low, mean - deviation);
      scale.high = std::max(scale.high, mean + deviation);
    }
  }
  const double step = round_step(std::max(scale.high - scale.low, 1.0) / 5);
  scale.low = step * std::floor(scale.low / step);
  scale.high = std::max(scale.low + step, step * std::ceil(scale.high / step));
  Svg svg({{"viewBox", fmt::format("0 0 {} {}", kPanelWidth, kPanelHeight)}, {"font-family", "sans-serif"}, {"font-size", 11}});
  svg.text({kPanelLeft, 16}, panel.title + ", °", {{"font-weight", "bold"}});
  for (double v = scale.low; v <= scale.high + 1e-9; v += step) {
    const double y = scale.y(v);
    svg.line({kPanelLeft, y}, {kPanelWidth - kPanelRight, y}, {{"class", std::abs(v) < 1e-9 ? "zero" : "grid"}});
    svg.text({kPanelLeft - 5, y + 4}, fmt::format("{:g}", std::round(v * 1000) / 1000 + 0.0), {{"text-anchor", "end"}});
  }
  for (const int percent : {0, 25, 50, 75, 100}) {
    const bool last = percent == 100;  // ends at the panel's edge: about its middle it would be cut off
    const double x = last ? kPanelWidth - 2 : kPanelLeft + (kPanelWidth - kPanelLeft - kPanelRight) * percent / 100.0;
    svg.text({x, kPanelHeight - 12}, fmt::format("{}{}", percent, last ? " %" : ""), {{"text-anchor", last ? "end" : "middle"}});
  }
  add_band(svg, panel.left, scale, kLeftColour);
  add_band(svg, panel.right, scale, kRightColour);
  return svg.str();
}

std::string figure_cell(const GaitReport::Figure& figure, std::size_t side) {
  if (!figure.mean[side]) return "–";
  const double mean = *figure.mean[side];
  const int decimals = std::clamp(2 - static_cast<int>(std::floor(std::log10(std::max(std::abs(mean), 1e-9)))), 0, 3);
  return figure.deviation[side] ? fmt::format("{:.{}f} ± {:.{}f}", mean, decimals, *figure.deviation[side], decimals)
                                : fmt::format("{:.{}f}", mean, decimals);
}

PageTable figures_of(const GaitReport& report) {
  PageTable table{.title = "The walk", .head = {"", "left", "right"}, .rows = {}};
  table.bars_end = 0;
  for (const GaitReport::Figure& figure : report.figures)
    table.rows.push_back(
        {figure.unit.empty() ? figure.name : figure.name + ", " + figure.unit, figure_cell(figure, 0), figure_cell(figure, 1)});
  return table;
}

PageTable events_of(const GaitReport& report) {
  PageTable table{.title = "Events", .head = {"time, s", "side", "event", "deviation, ms"}, .rows = {}};
  table.bars_end = 0;
  for (const GaitReport::Event& event : report.events)
    table.rows.push_back(
        {fmt::format("{:.3f}", event.time_s), event.side, event.kind, fmt::format("{:.0f}", 1000 * event.deviation_s)});
  return table;
}

}  // namespace

std::string to_html(const GaitReport& report) {
  Page page(report.title);
  page.add_message(
      "Angles over the gait cycle: mean over the cycles, from a strike of the foot to its next; the band is one standard "
      "deviation.");
  page.add_legend({{"left", kLeftColour}, {"right", kRightColour}});
  page.add_list(report.notes);
  page.add(figures_of(report));
  page.add_heading("Angles");
  page.add_html("<div class=\"four\">");
  for (const GaitReport::Panel& panel : report.panels) page.add_html("<figure>" + panel_svg(panel) + "</figure>");
  page.add_html("</div>\n");
  page.add(events_of(report));
  return page.html();
}

}  // namespace marey::draw
