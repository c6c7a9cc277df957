#include "marey/pipeline/measure_gait.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/whole_file.h"
#include "marey/draw/gait_report.h"
#include "marey/pipeline/gait_markers.h"

namespace marey::pipeline {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

/// Where the person walks to: the middle of the hips, over half a second on either side.
Vector<2> heading_at(const gait::MarkerPath& sacrum, std::size_t row, double rate_hz) {
  const auto around = static_cast<std::size_t>(std::lround(0.5 * rate_hz));
  std::optional<Vector<3>> from, to;
  for (std::size_t r = row > around ? row - around : 0; r <= std::min(row + around, sacrum.size() - 1); ++r) {
    if (!sacrum[r]) continue;
    if (!from) from = sacrum[r];
    to = sacrum[r];
  }
  return from ? Vector<2>((*to - *from).head<2>()) : Vector<2>(Vector<2>::Zero());
}

std::vector<gait::AngleCurve> angle_curves(const GaitMarkers& markers, const gait::GaitSubject& subject,
                                           const gait::MarkerPath& sacrum) {
  std::vector<gait::AngleCurve> curves;
  for (const std::string& name : gait::angle_names()) curves.push_back({name, {}});
  for (std::size_t r = 0; r < markers.rows.size(); ++r) {
    const auto angles = gait::angles_of(gait::pose_of(markers.rows[r], subject), heading_at(sacrum, r, markers.rate_hz));
    for (std::size_t a = 0; a < curves.size(); ++a) curves[a].values.push_back(angles[a]);
  }
  for (gait::AngleCurve& curve : curves) gait::unwrap(curve.values);
  return curves;
}

gait::FeetPaths feet_of(const GaitMarkers& markers) {
  gait::FeetPaths feet;
  feet.heel = {markers.path("LHEE"), markers.path("RHEE")};
  feet.toe = {markers.path("LTOE"), markers.path("RTOE")};
  feet.sacrum = markers.path("SACR");
  for (const char* other : {"LPSI", "LASI"}) {
    if (std::none_of(feet.sacrum.begin(), feet.sacrum.end(), [](const auto& place) { return place.has_value(); }))
      feet.sacrum = markers.path(other);
  }
  return feet;
}

void write_cycles(const std::string& path, const gait::GaitCycles& cycles) {
  WholeFile file(path);
  std::string text = "angle,percent,mean_deg,deviation_deg,cycles\n";
  for (const gait::CycleCurve& curve : cycles.curves) {
    if (curve.cycles.empty()) continue;
    for (std::size_t p = 0; p < gait::kCyclePoints; ++p)
      fmt::format_to(std::back_inserter(text), "{},{},{:.4f},{:.4f},{}\n", curve.name, p, curve.mean[p] * kDegrees,
                     curve.deviation[p] * kDegrees, curve.cycles.size());
  }
  file.write(text);
  file.finish();
}

void write_angles(const std::string& path, const GaitMeasure& measure) {
  WholeFile file(path);
  std::string text = "time_s";
  for (const gait::AngleCurve& curve : measure.angles) text.append(1, ',').append(curve.name);
  text += '\n';
  for (std::int64_t r = 0; r < measure.frames; ++r) {
    fmt::format_to(std::back_inserter(text), "{:.6g}", measure.begin_s + static_cast<double>(r) / measure.rate_hz);
    for (const gait::AngleCurve& curve : measure.angles) {
      const auto& value = curve.values[static_cast<std::size_t>(r)];
      text += value ? fmt::format(",{:.4f}", *value * kDegrees) : ",";
    }
    text += '\n';
  }
  file.write(text);
  file.finish();
}

/// "left_knee_flexion" on the page: knee flexion, of the left.
void write_gait_report(const std::string& path, const std::string& recording, const GaitMeasure& measure) {
  draw::GaitReport report;
  report.title = std::filesystem::path(recording).filename().string();
  for (const gait::CycleCurve& curve : measure.cycles.curves) {
    if (curve.cycles.empty()) continue;
    const bool left = curve.name.starts_with("left_");
    std::string joint = curve.name.substr(left ? 5 : 6);
    std::replace(joint.begin(), joint.end(), '_', ' ');
    const auto panel = std::find_if(report.panels.begin(), report.panels.end(), [&](const auto& p) { return p.title == joint; });
    draw::GaitReport::Panel& at =
        panel != report.panels.end() ? *panel : report.panels.emplace_back(draw::GaitReport::Panel{joint, {}, {}});
    std::vector<std::pair<double, double>>& band = left ? at.left : at.right;
    for (std::size_t p = 0; p < gait::kCyclePoints; ++p) band.emplace_back(curve.mean[p] * kDegrees, curve.deviation[p] * kDegrees);
  }
  for (const gait::GaitFigure& figure : measure.cycles.figures)
    report.figures.push_back({figure.name, figure.unit, figure.mean, figure.deviation});
  for (const gait::GaitEvent& event : measure.events)
    report.events.push_back({event.side == gait::Side::left ? "left" : "right", event.strike ? "strike" : "off",
                             measure.begin_s + event.time_s, event.deviation_s});
  WholeFile file(path);
  file.write(draw::to_html(report));
  file.finish();
}

}  // namespace

GaitMeasure measure_gait(const std::string& recording, const GaitOptions& options, const Hooks& hooks) {
  GaitMeasure measure;
  measure.subject = options.subject;
  const GaitMarkers markers = read_gait_markers(recording, options.up, hooks);
  measure.warnings = markers.warnings;
  measure.frames = std::ssize(markers.rows);
  measure.rate_hz = markers.rate_hz;
  measure.begin_s = markers.begin_s;
  take_measures(recording, measure.subject);
  if (!options.static_trial.empty()) {
    take_measures(options.static_trial, measure.subject);
    measure.subject.learn_from(standing_places(read_gait_markers(options.static_trial, options.up, hooks), options.static_trial));
  } else {
    if (!measure.subject.leg_length[0] && !markers.rows.empty()) measure.subject.learn_from(markers.rows.front());
    measure.warnings.push_back(
        fmt::format("{}: no static trial, so that the ankles' zero is the line from ankle to toe", recording));
    measure.subject.sole_from_ankle_toe = options.subject.sole_from_ankle_toe;
  }
  take_soles(recording, measure.subject);
  const gait::FeetPaths feet = feet_of(markers);
  measure.angles = angle_curves(markers, measure.subject, feet.sacrum);
  const bool any = std::any_of(measure.angles.begin(), measure.angles.end(), [](const gait::AngleCurve& curve) {
    return std::any_of(curve.values.begin(), curve.values.end(), [](const auto& value) { return value.has_value(); });
  });
  if (!any)
    throw Error(
        "{}: has not the markers of Plug-in Gait that angles need: LASI, RASI and SACR (or LPSI, RPSI), then THI, KNE, TIB, ANK of "
        "a side",
        recording);
  measure.events = gait::gait_events(feet, measure.rate_hz, options.events);
  if (measure.events.empty())
    measure.warnings.push_back(fmt::format("{}: no steps were found: HEE and TOE of a side are needed, and a walk", recording));
  measure.cycles = gait::gait_cycles(measure.events, measure.angles, feet, measure.rate_hz);
  return measure;
}

GaitMeasure measure_gait(const std::string& recording, const GaitOutput& output, const GaitOptions& options, const Hooks& hooks) {
  GaitMeasure measure = measure_gait(recording, options, hooks);
  if (!output.cycles.empty()) write_cycles(output.cycles, measure.cycles);
  if (!output.angles.empty()) write_angles(output.angles, measure);
  if (!output.report.empty()) write_gait_report(output.report, recording, measure);
  return measure;
}

}  // namespace marey::pipeline
