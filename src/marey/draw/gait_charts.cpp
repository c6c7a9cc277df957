#include "marey/draw/gait_charts.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>

#include <fmt/format.h>

#include "marey/draw/svg.h"

namespace marey::draw {
namespace {

constexpr double kPanelTop = 24, kPanelBottom = 20, kPanelLeft = 40, kPanelRight = 8;
constexpr std::size_t kMaxDrawnCycles = 30;  // more lines are one grey field
constexpr const char* kReferenceGrey = "#7f8c8d";
constexpr std::array<const char*, 2> kSideColours = {kGaitLeft, kGaitRight};

struct PanelSize {
  double width, height;
};
// Three in a row of A4 with both sides, four with one: letters are as large in both.
constexpr PanelSize kWidePanel{300, 186}, kNarrowPanel{226, 140};

class PanelChart {
 public:
  PanelChart(const GaitReport::Panel& panel, GaitSides sides, const GaitReport& report)
      : panel_(panel), sides_(sides), report_(report), size_(sides == GaitSides::both ? kWidePanel : kNarrowPanel) {
    find_range();
  }

  std::string write() const {
    Svg svg(
        {{"viewBox", fmt::format("0 0 {:g} {:g}", size_.width, size_.height)}, {"font-family", "sans-serif"}, {"font-size", 11}});
    const std::string title = panel_.title + ", " + panel_.unit;
    const double fits = (size_.width - 8) / (0.62 * static_cast<double>(title.size()));  // bold letters are about so wide
    svg.text({4, 14}, title, {{"font-weight", "bold"}, {"font-size", std::min(11.0, std::floor(2 * fits) / 2)}});
    draw_axes(svg);
    draw_band(svg, panel_.reference, kReferenceGrey, "0.28", "0");
    for (std::size_t s = 0; s < 2; ++s) {
      if (is_drawn(s)) draw_side(svg, s);
    }
    return svg.str();
  }

 private:
  bool is_drawn(std::size_t side) const { return sides_ == GaitSides::both || (sides_ == GaitSides::left) == (side == 0); }

  void find_range() {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    const auto take = [&](const GaitReport::Curve& curve) {
      for (std::size_t i = 0; i < curve.mean.size(); ++i) {
        const double deviation = i < curve.deviation.size() ? curve.deviation[i] : 0;
        low = std::min(low, curve.mean[i] - deviation);
        high = std::max(high, curve.mean[i] + deviation);
      }
    };
    take(panel_.reference);
    for (const GaitReport::Side& side : panel_.sides) {  // both, so that a side's own sheet has the same scale as the other's
      take(side.now);
      take(side.before);
      if (sides_ == GaitSides::both) continue;
      for (const auto& cycle : side.cycles) take({cycle, {}});
    }
    if (!(low <= high)) low = high = 0;
    step_ = round_step(std::max(high - low, 1e-6 + 1e-3 * std::abs(high)) / 4);
    low_ = step_ * std::floor(low / step_);
    high_ = std::max(low_ + step_, step_ * std::ceil(high / step_));
  }

  double x(double fraction) const { return kPanelLeft + (size_.width - kPanelLeft - kPanelRight) * fraction; }
  double y(double value) const {
    return size_.height - kPanelBottom - (size_.height - kPanelTop - kPanelBottom) * (value - low_) / (high_ - low_);
  }

  void draw_axes(Svg& svg) const {
    for (double v = low_; v <= high_ + 0.01 * step_; v += step_) {
      svg.line({kPanelLeft, y(v)}, {size_.width - kPanelRight, y(v)}, {{"class", std::abs(v) < 0.01 * step_ ? "zero" : "grid"}});
      svg.text({kPanelLeft - 4, y(v) + 4}, fmt::format("{:.6g}", std::round(v / step_) * step_ + 0.0), {{"text-anchor", "end"}});
    }
    for (const int percent : {0, 25, 50, 75, 100}) {
      const bool last = percent == 100;  // ends at the panel's edge: about its middle it would be cut off
      svg.text({last ? size_.width - 2 : x(percent / 100.0), size_.height - 6}, fmt::format("{}{}", percent, last ? " %" : ""),
               {{"text-anchor", last ? "end" : "middle"}});
    }
  }

  std::vector<Vector<2>> points_of(const std::vector<double>& values) const {
    std::vector<Vector<2>> points;
    for (std::size_t i = 0; i < values.size(); ++i)
      points.emplace_back(x(static_cast<double>(i) / static_cast<double>(std::max<std::size_t>(values.size(), 2) - 1)),
                          y(values[i]));
    return points;
  }

  void draw_band(Svg& svg, const GaitReport::Curve& curve, const char* colour, const char* opacity, const char* line_width) const {
    if (curve.mean.empty()) return;
    if (!curve.deviation.empty()) {
      std::vector<double> above = curve.mean, below = curve.mean;
      for (std::size_t i = 0; i < curve.mean.size(); ++i) {
        above[i] += curve.deviation[i];
        below[i] -= curve.deviation[i];
      }
      std::vector<Vector<2>> band = points_of(above);
      const std::vector<Vector<2>> back = points_of(below);
      band.insert(band.end(), back.rbegin(), back.rend());
      svg.polygon(band, {{"fill", colour}, {"fill-opacity", opacity}});
    }
    const bool reference = curve.deviation.empty() && std::string_view(line_width) == "0";  // of one person: there is no band
    if (std::string_view(line_width) != "0" || reference)
      svg.polyline(points_of(curve.mean), {{"stroke", colour}, {"stroke-width", reference ? "1" : line_width}});
  }

  void draw_side(Svg& svg, std::size_t s) const {
    const GaitReport::Side& side = panel_.sides[s];
    const bool alone = sides_ != GaitSides::both;
    if (report_.off_percent[s] && !side.now.mean.empty()) {
      const double at = x(*report_.off_percent[s] / 100);
      svg.line({at, kPanelTop}, {at, size_.height - kPanelBottom},
               {{"stroke", kSideColours[s]}, {"stroke-width", 0.8}, {"stroke-dasharray", "2 3"}});
    }
    for (std::size_t c = 0; alone && c < std::min(side.cycles.size(), kMaxDrawnCycles); ++c)
      svg.polyline(points_of(side.cycles[c]), {{"stroke", kSideColours[s]}, {"stroke-width", 0.5}, {"stroke-opacity", 0.55}});
    draw_band(svg, side.now, kSideColours[s], "0.18", "1.6");
    if (alone && !side.before.mean.empty())
      svg.polyline(points_of(side.before.mean), {{"class", "before"}, {"stroke-width", 1.3}, {"stroke-dasharray", "5 3"}});
  }

  const GaitReport::Panel& panel_;
  GaitSides sides_;
  const GaitReport& report_;
  PanelSize size_;
  double low_ = 0, high_ = 1, step_ = 1;
};

constexpr double kProfileWidth = 720, kProfileHeight = 230, kProfileLeft = 34, kProfileTop = 16, kProfileBottom = 38;

/// "hip adduction" in two lines.
std::pair<std::string, std::string> two_lines(const std::string& name) {
  const std::size_t blank = name.find(' ');
  return blank == std::string::npos ? std::pair(name, std::string()) : std::pair(name.substr(0, blank), name.substr(blank + 1));
}

}  // namespace

std::string gait_panel(const GaitReport::Panel& panel, GaitSides sides, const GaitReport& report) {
  return PanelChart(panel, sides, report).write();
}

std::string gait_profile_chart(const GaitReport& report) {
  double high = 1;
  for (const GaitReport::Figure& score : report.scores) {
    for (std::size_t s = 0; s < 2; ++s) high = std::max(high, score.mean[s].value_or(0) + score.deviation[s].value_or(0));
    high = std::max(high, score.reference.value_or(0) + score.reference_deviation.value_or(0));
  }
  const double step = round_step(high / 5), top = step * std::ceil(1.05 * high / step);
  const auto y = [&](double value) {
    return kProfileHeight - kProfileBottom - (kProfileHeight - kProfileTop - kProfileBottom) * value / top;
  };
  Svg svg({{"viewBox", fmt::format("0 0 {} {}", kProfileWidth, kProfileHeight)}, {"font-family", "sans-serif"}, {"font-size", 11}});
  for (double v = 0; v <= top + 0.01 * step; v += step) {
    svg.line({kProfileLeft, y(v)}, {kProfileWidth, y(v)}, {{"class", v == 0 ? "zero" : "grid"}});
    svg.text({kProfileLeft - 5, y(v) + 4}, fmt::format("{:.6g}°", v), {{"text-anchor", "end"}});
  }
  const double group = (kProfileWidth - kProfileLeft) / static_cast<double>(std::max<std::size_t>(report.scores.size(), 1));
  const double bar = 0.3 * group;
  for (std::size_t i = 0; i < report.scores.size(); ++i) {
    const GaitReport::Figure& score = report.scores[i];
    const double left = kProfileLeft + group * static_cast<double>(i), middle = left + group / 2;
    if (score.reference) {
      const double from = y(*score.reference);
      svg.rect(Box{left + 3, from, group - 6, y(0) - from}, {{"fill", kReferenceGrey}, {"fill-opacity", 0.35}});
      if (score.reference_deviation)
        svg.line({middle, from}, {middle, y(*score.reference + *score.reference_deviation)},
                 {{"stroke", kReferenceGrey}, {"stroke-width", 1.5}});
    }
    for (std::size_t s = 0; s < 2; ++s) {
      if (!score.mean[s]) continue;
      const double x = s == 0 ? middle - bar - 1.5 : middle + 1.5, at = y(*score.mean[s]);
      svg.rect(Box{x, at, bar, y(0) - at}, {{"fill", kSideColours[s]}, {"fill-opacity", 0.85}});
      svg.text({x + bar / 2, at - 3}, fmt::format("{:.1f}", *score.mean[s]), {{"text-anchor", "middle"}, {"font-size", 9}});
      if (score.before[s])
        svg.line({x - 1, y(*score.before[s])}, {x + bar + 1, y(*score.before[s])},
                 {{"class", "before"}, {"stroke-width", 1.6}, {"stroke-dasharray", "4 2"}});
    }
    const auto [first, second] = two_lines(score.name);
    svg.text({middle, kProfileHeight - 22}, first, {{"text-anchor", "middle"}});
    svg.text({middle, kProfileHeight - 8}, second, {{"text-anchor", "middle"}});
  }
  return svg.str();
}

}  // namespace marey::draw
