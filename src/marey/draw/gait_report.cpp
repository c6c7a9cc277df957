#include "marey/draw/gait_report.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "marey/draw/svg_text.h"

namespace marey::draw {
namespace {

constexpr double kPanelWidth = 300, kPanelHeight = 190, kPanelLeft = 44, kPanelTop = 26, kPanelBottom = 28, kPanelRight = 8;
constexpr const char* kLeftColour = "#c0392b";
constexpr const char* kRightColour = "#1f77b4";

/// A step of 1, 2 or 5 that gives four to eight lines.
double grid_step(double range) {
  const double rough = std::max(range, 1.0) / 5, power = std::pow(10, std::floor(std::log10(rough)));
  for (const double m : {1.0, 2.0, 5.0}) {
    if (rough <= m * power) return m * power;
  }
  return 10 * power;
}

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

void append_band(std::string& svg, const std::vector<std::pair<double, double>>& curve, const PanelScale& scale,
                 const char* colour) {
  if (curve.empty()) return;
  auto out = std::back_inserter(svg);
  fmt::format_to(out, "<polygon fill=\"{}\" fill-opacity=\"0.18\" points=\"", colour);
  for (std::size_t i = 0; i < curve.size(); ++i)
    fmt::format_to(out, "{:.1f},{:.1f} ", scale.x(i), scale.y(curve[i].first + curve[i].second));
  for (std::size_t i = curve.size(); i-- > 0;)
    fmt::format_to(out, "{:.1f},{:.1f} ", scale.x(i), scale.y(curve[i].first - curve[i].second));
  fmt::format_to(out, "\"/><polyline fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\" points=\"", colour);
  for (std::size_t i = 0; i < curve.size(); ++i) fmt::format_to(out, "{:.1f},{:.1f} ", scale.x(i), scale.y(curve[i].first));
  svg += "\"/>\n";
}

std::string panel_svg(const GaitReport::Panel& panel) {
  PanelScale scale{.low = 1e9, .high = -1e9, .points = std::max(panel.left.size(), panel.right.size())};
  for (const auto* curve : {&panel.left, &panel.right}) {
    for (const auto& [mean, deviation] : *curve) {
      scale.low = std::min(scale.low, mean - deviation);
      scale.high = std::max(scale.high, mean + deviation);
    }
  }
  const double step = grid_step(scale.high - scale.low);
  scale.low = step * std::floor(scale.low / step);
  scale.high = std::max(scale.low + step, step * std::ceil(scale.high / step));
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" font-family=\"sans-serif\" "
      "font-size=\"11\">\n",
      kPanelWidth, kPanelHeight);
  auto out = std::back_inserter(svg);
  fmt::format_to(out, "<text x=\"{}\" y=\"16\" font-weight=\"bold\">{}, °</text>\n", kPanelLeft, escaped(panel.title));
  for (double v = scale.low; v <= scale.high + 1e-9; v += step) {
    fmt::format_to(out,
                   "<line x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\"/><text x=\"{}\" y=\"{:.1f}\" "
                   "text-anchor=\"end\">{:g}</text>\n",
                   kPanelLeft, kPanelWidth - kPanelRight, scale.y(v), scale.y(v), std::abs(v) < 1e-9 ? "#888" : "#ddd",
                   kPanelLeft - 5, scale.y(v) + 4, std::round(v * 1000) / 1000 + 0.0);
  }
  for (const int percent : {0, 25, 50, 75, 100})
    fmt::format_to(out, "<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}{}</text>\n",
                   kPanelLeft + (kPanelWidth - kPanelLeft - kPanelRight) * percent / 100.0, kPanelHeight - 12, percent,
                   percent == 100 ? " %" : "");
  append_band(svg, panel.left, scale, kLeftColour);
  append_band(svg, panel.right, scale, kRightColour);
  return svg + "</svg>\n";
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
      escaped(report.title));
  html += fmt::format(
      "<p><span style=\"color:{}\">left</span>, <span style=\"color:{}\">right</span>: mean over the cycles, from a strike of the "
      "foot to its next; the band is one standard deviation.</p>\n",
      kLeftColour, kRightColour);
  auto out = std::back_inserter(html);
  html += "<table><tr><th></th><th>left</th><th>right</th><th></th></tr>\n";
  for (const GaitReport::Figure& figure : report.figures)
    fmt::format_to(out, "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n", escaped(figure.name), figure_cell(figure, 0),
                   figure_cell(figure, 1), escaped(figure.unit));
  html += "</table>\n";
  if (!report.notes.empty()) html += "<ul>\n";
  for (const std::string& note : report.notes) fmt::format_to(out, "<li>{}</li>\n", escaped(note));
  html += report.notes.empty() ? "<p>\n" : "</ul>\n<p>\n";
  for (const GaitReport::Panel& panel : report.panels) html += panel_svg(panel);
  html += "</p>\n<h2>Events</h2>\n<table><tr><th>time, s</th><th>side</th><th>event</th><th>deviation, ms</th></tr>\n";
  for (const GaitReport::Event& event : report.events)
    fmt::format_to(out, "<tr><td>{:.3f}</td><td>{}</td><td>{}</td><td>{:.0f}</td></tr>\n", event.time_s, escaped(event.side),
                   escaped(event.kind), 1000 * event.deviation_s);
  return html + "</table>\n</body></html>\n";
}

}  // namespace marey::draw
