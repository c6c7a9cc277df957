#include "marey/draw/gait_report.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "marey/core/text_safety.h"
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
  Svg svg({{"width", kPanelWidth},
           {"height", kPanelHeight},
           {"viewBox", fmt::format("0 0 {} {}", kPanelWidth, kPanelHeight)},
           {"font-family", "sans-serif"},
           {"font-size", 11}});
  svg.text({kPanelLeft, 16}, panel.title + ", °", {{"font-weight", "bold"}});
  for (double v = scale.low; v <= scale.high + 1e-9; v += step) {
    const double y = scale.y(v);
    svg.line({kPanelLeft, y}, {kPanelWidth - kPanelRight, y}, {{"stroke", std::abs(v) < 1e-9 ? "#888" : "#ddd"}});
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
  return figure.deviation[side] ? fmt::format("{:.3g} ± {:.2g}", *figure.mean[side], *figure.deviation[side])
                                : fmt::format("{:.3g}", *figure.mean[side]);
}

}  // namespace

std::string to_html(const GaitReport& report) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta "
      "charset=\"utf-8\"><title>{0}</title>\n<style>body{{font-family:sans-serif;max-width:1000px;margin:2em auto}}"
      "table{{border-collapse:collapse}}td,th{{border:1px solid #ccc;padding:3px "
      "10px;text-align:left}}</style></head>\n<body><h1>{0}</h1>\n",
      xml_escaped(report.title));
  html += fmt::format(
      "<p><span style=\"color:{}\">left</span>, <span style=\"color:{}\">right</span>: mean over the cycles, from a strike of the "
      "foot to its next; the band is one standard deviation.</p>\n",
      kLeftColour, kRightColour);
  auto out = std::back_inserter(html);
  html += "<table><tr><th></th><th>left</th><th>right</th><th></th></tr>\n";
  for (const GaitReport::Figure& figure : report.figures)
    fmt::format_to(out, "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n", xml_escaped(figure.name), figure_cell(figure, 0),
                   figure_cell(figure, 1), xml_escaped(figure.unit));
  html += "</table>\n";
  if (!report.notes.empty()) html += "<ul>\n";
  for (const std::string& note : report.notes) fmt::format_to(out, "<li>{}</li>\n", xml_escaped(note));
  html += report.notes.empty() ? "<p>\n" : "</ul>\n<p>\n";
  for (const GaitReport::Panel& panel : report.panels) html += panel_svg(panel);
  html += "</p>\n<h2>Events</h2>\n<table><tr><th>time, s</th><th>side</th><th>event</th><th>deviation, ms</th></tr>\n";
  for (const GaitReport::Event& event : report.events)
    fmt::format_to(out, "<tr><td>{:.3f}</td><td>{}</td><td>{}</td><td>{:.0f}</td></tr>\n", event.time_s, xml_escaped(event.side),
                   xml_escaped(event.kind), 1000 * event.deviation_s);
  return html + "</table>\n</body></html>\n";
}

}  // namespace marey::draw
