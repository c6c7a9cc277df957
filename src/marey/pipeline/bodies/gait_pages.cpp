#include "marey/pipeline/bodies/gait_pages.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "marey/draw/gait_report.h"
#include "marey/files/whole_file.h"

namespace marey::pipeline::bodies {
namespace {

using draw::GaitReport;

constexpr double kToDegrees = 180 / std::numbers::pi;  // by definition
constexpr std::size_t kShownPairs = 8;                 // by definition of the page

/// "walks/a.c3d: …": the page names the file, not its folder.
std::string without_folder(const std::string& sentence) {
  const std::size_t end = std::min(sentence.find(": "), sentence.size());
  return std::filesystem::path(sentence.substr(0, end)).filename().string() + sentence.substr(end);
}

std::string file_name(const std::string& path) {
  const std::filesystem::path whole(path);
  return whole.has_filename() ? whole.filename().string() : whole.parent_path().filename().string();
}

std::string in_words(std::string_view name) {
  std::string words(name);
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

std::vector<double> scaled(std::span<const double> points, double scale) {
  std::vector<double> values;
  for (const double point : points) values.push_back(scale * point);
  return values;
}

/// A deviation of one cycle is not known.
GaitReport::Curve curve_of(const gait::CyclePoints& mean, const gait::CyclePoints& deviation, std::size_t count, double scale) {
  return {.mean = scaled(mean, scale), .deviation = count > 1 ? scaled(deviation, scale) : std::vector<double>()};
}

GaitReport::Panel& panel_titled(std::vector<GaitReport::Panel>& panels, const std::string& title, const std::string& unit) {
  const auto panel = std::find_if(panels.begin(), panels.end(), [&](const auto& p) { return p.title == title; });
  return panel != panels.end() ? *panel
                               : panels.emplace_back(GaitReport::Panel{.title = title, .unit = unit, .sides = {}, .reference = {}});
}

/// Whole turns that an angle of another recording is off: its middle is within half a turn of this one's.
double revolutions_to(const gait::CyclePoints& near, const gait::CyclePoints& points) {
  return 2 * std::numbers::pi *
         std::round((near[gait::kCyclePoints / 2] - points[gait::kCyclePoints / 2]) / (2 * std::numbers::pi));
}

gait::CyclePoints shifted(gait::CyclePoints points, double turns) {
  for (double& point : points) point += turns;
  return points;
}

/// "0.00003 V" as 30 µV: the unit in which the largest mean is one or more.
void scale_voltage(GaitReport::Panel& panel) {
  double largest = 0;
  for (const GaitReport::Side& side : panel.sides) {
    for (const double value : side.now.mean) largest = std::max(largest, std::abs(value));
  }
  if (panel.unit != "V" || largest >= 1 || largest == 0) return;
  const double scale = largest < 1e-3 ? 1e6 : 1e3;
  panel.unit = largest < 1e-3 ? "µV" : "mV";
  for (GaitReport::Side& side : panel.sides) {
    for (auto* values : {&side.now.mean, &side.now.deviation, &side.before.mean, &side.before.deviation}) {
      for (double& value : *values) value *= scale;
    }
    for (auto& cycle : side.cycles) {
      for (double& value : cycle) value *= scale;
    }
  }
}

class ReportOfWalk {
 public:
  ReportOfWalk(const std::string& recording, const GaitMeasure& measure) : recording_(recording), measure_(measure) {}

  GaitReport make() {
    report_.title = file_name(recording_);
    for (const std::string& warning : measure_.warnings) report_.warnings.push_back(without_folder(warning));
    add_lead();
    add_angles();
    add_signals();
    add_figures();
    add_scores();
    add_quality();
    for (const gait::GaitEvent& event : measure_.events)
      report_.events.push_back({event.side == gait::Side::left ? "left" : "right", event.strike ? "strike" : "off",
                                measure_.begin_s + event.time_s, event.deviation_s});
    return std::move(report_);
  }

 private:
  const GaitMeasure* before() const { return measure_.before.get(); }

  void add_lead() {
    report_.lead.push_back(fmt::format("{} gait cycles, {} of the left foot and {} of the right, in {:.2f} s at {:g} Hz.",
                                       measure_.cycles.cycles.size(), cycles_of(gait::Side::left), cycles_of(gait::Side::right),
                                       static_cast<double>(measure_.frames) / measure_.rate_hz, measure_.rate_hz));
    if (measure_.reference) {
      const GaitReference& group = *measure_.reference;
      report_.lead.push_back(fmt::format("Control group: {}, {} {}, {} walks, {} cycles.", file_name(group.folder),
                                         group.people.size(), group.people.size() == 1 ? "person" : "people", group.walks,
                                         group.cycles));
    }
    if (before() != nullptr)
      report_.lead.push_back(
          fmt::format("Before: {}, {} gait cycles.", file_name(measure_.before_name), before()->cycles.cycles.size()));
  }

  std::ptrdiff_t cycles_of(gait::Side side) const {
    return std::count_if(measure_.cycles.cycles.begin(), measure_.cycles.cycles.end(),
                         [&](const auto& cycle) { return cycle.side == side; });
  }

  void add_angles() {
    for (const gait::CycleCurve& curve : measure_.cycles.curves) {
      if (curve.cycles.empty()) continue;
      const std::string name(gait::without_side(curve.name));
      const bool leg = name.starts_with("pelvis") || name.starts_with("hip") || name.starts_with("knee") ||
                       name.starts_with("ankle") || name.starts_with("foot");
      GaitReport::Panel& panel = panel_titled(leg ? report_.legs : report_.trunk, in_words(name), "°");
      GaitReport::Side& side = panel.sides[static_cast<std::size_t>(gait::side_of_curve(curve.name))];
      side.now = curve_of(curve.mean, curve.deviation, curve.cycles.size(), kToDegrees);
      for (const gait::CyclePoints& cycle : curve.cycles) side.cycles.push_back(scaled(cycle, kToDegrees));
      if (measure_.reference && panel.reference.mean.empty()) {
        for (const gait::ReferenceBand& band : measure_.reference->bands) {
          if (band.name == name)
            panel.reference =
                curve_of(shifted(band.mean, revolutions_to(curve.mean, band.mean)), band.deviation, band.people, kToDegrees);
        }
      }
      if (before() == nullptr) continue;
      for (const gait::CycleCurve& earlier : before()->cycles.curves) {
        if (earlier.name == curve.name && !earlier.cycles.empty())
          side.before = curve_of(shifted(earlier.mean, revolutions_to(curve.mean, earlier.mean)), earlier.deviation,
                                 earlier.cycles.size(), kToDegrees);
      }
    }
  }

  /// One signal of `now`, and the same of the earlier session if its unit is the same.
  void add_signal(std::vector<GaitReport::Panel>& panels, const std::string& title, const gait::SignalCurve& now,
                  const std::vector<gait::SignalCurve>* earlier) {
    GaitReport::Panel& panel = panel_titled(panels, title, now.unit.empty() ? "file's unit" : now.unit);
    GaitReport::Side& side = panel.sides[static_cast<std::size_t>(now.side)];
    side.now = curve_of(now.mean, now.deviation, now.cycles.size(), 1);
    for (const gait::CyclePoints& cycle : now.cycles) side.cycles.push_back(scaled(cycle, 1));
    if (measure_.reference) {
      for (const gait::ReferenceSignal& signal : measure_.reference->signals) {
        if (signal.label == now.label && signal.unit == now.unit)
          panel.reference = curve_of(signal.mean, signal.deviation, signal.people, 1);
      }
    }
    if (earlier == nullptr) return;
    for (const gait::SignalCurve& curve : *earlier) {
      if (curve.label == now.label && curve.side == now.side && curve.unit == now.unit)
        side.before = curve_of(curve.mean, curve.deviation, curve.cycles.size(), 1);
    }
  }

  void add_signals() {
    for (const gait::SignalCurve& curve : measure_.ground)
      add_signal(report_.forces, "ground reaction " + curve.label, curve, before() != nullptr ? &before()->ground : nullptr);
    for (const gait::SignalCurve& curve : measure_.kinetics.curves)
      add_signal(report_.forces, curve.label, curve, before() != nullptr ? &before()->kinetics.curves : nullptr);
    for (const gait::SignalCurve& curve : measure_.muscles)
      add_signal(report_.muscles, "EMG " + curve.label.substr(curve.label.find_last_of(".:") + 1), curve,
                 before() != nullptr ? &before()->muscles : nullptr);
    for (GaitReport::Panel& panel : report_.muscles) scale_voltage(panel);
  }

  void add_figures() {
    for (const gait::GaitFigure& figure : measure_.cycles.figures) {
      GaitReport::Figure& row = report_.figures.emplace_back(GaitReport::Figure{.name = figure.name,
                                                                                .unit = figure.unit,
                                                                                .mean = figure.mean,
                                                                                .deviation = figure.deviation,
                                                                                .before = {},
                                                                                .reference = {},
                                                                                .reference_deviation = {}});
      if (measure_.reference) {
        for (const gait::ReferenceFigure& of : measure_.reference->figures) {
          if (of.name != figure.name) continue;
          row.reference = of.mean;
          row.reference_deviation = of.deviation;
        }
      }
      if (before() == nullptr) continue;
      for (const gait::GaitFigure& earlier : before()->cycles.figures) {
        if (earlier.name == figure.name) row.before = earlier.mean;
      }
    }
    for (std::size_t side = 0; side < 2; ++side) {
      for (const gait::GaitFigure& figure : measure_.cycles.figures) {
        if (figure.name == "stance") report_.off_percent[side] = figure.mean[side];
      }
    }
  }

  static std::array<std::optional<double>, 2> degrees(std::array<std::optional<double>, 2> sides) {
    for (auto& side : sides) {
      if (side) *side *= kToDegrees;
    }
    return sides;
  }

  void add_score(const std::string& name, const std::string& title, const std::array<std::optional<double>, 2>& mean,
                 const std::array<std::optional<double>, 2>& deviation, const std::array<std::optional<double>, 2>& earlier) {
    GaitReport::Figure& row = report_.scores.emplace_back(GaitReport::Figure{.name = title,
                                                                             .unit = "",
                                                                             .mean = degrees(mean),
                                                                             .deviation = degrees(deviation),
                                                                             .before = degrees(earlier),
                                                                             .reference = {},
                                                                             .reference_deviation = {}});
    for (const gait::ReferenceScore& of : measure_.reference->scores) {
      if (of.name != name) continue;
      row.reference = of.mean * kToDegrees;
      row.reference_deviation = of.deviation * kToDegrees;
    }
  }

  void add_scores() {
    if (!measure_.profile) return;
    const gait::GaitProfile& profile = *measure_.profile;
    const gait::GaitProfile* earlier = before() != nullptr && before()->profile ? &*before()->profile : nullptr;
    for (std::size_t v = 0; v < profile.variables.size(); ++v) {
      const gait::VariableScore& variable = profile.variables[v];
      add_score(variable.name, in_words(variable.name), variable.mean, variable.deviation,
                earlier != nullptr ? earlier->variables[v].mean : std::array<std::optional<double>, 2>{});
    }
    add_score("GPS", "GPS", profile.score, profile.score_deviation,
              earlier != nullptr ? earlier->score : std::array<std::optional<double>, 2>{});
    if (profile.overall) report_.overall_score = *profile.overall * kToDegrees;
    if (earlier != nullptr && earlier->overall) report_.overall_before = *earlier->overall * kToDegrees;
  }

  void add_quality() {
    const GaitQuality& quality = measure_.quality;
    std::vector<std::string>& sentences = report_.quality;
    sentences.push_back(
        fmt::format("Markers: {} of the set in the file, {} of them missing at some time.", quality.markers, quality.gaps.size()));
    if (!quality.absent.empty())
      sentences.push_back(fmt::format("Of the full set these are not in the file, and not all of them are needed: {}.",
                                      fmt::join(quality.absent, ", ")));
    if (measure_.forces.feet[0].empty()) {
      sentences.emplace_back("Events are by kinematics: there are no force plates.");
    } else {
      const auto own = std::count_if(measure_.forces.contacts.begin(), measure_.forces.contacts.end(),
                                     [](const auto& contact) { return contact.side.has_value(); });
      sentences.push_back(fmt::format("Force plates: {} contacts, {} of one whole foot.", measure_.forces.contacts.size(), own));
      const auto& strikes = measure_.by_force.strikes;
      if (strikes.count > 0)
        sentences.push_back(fmt::format("Strikes by kinematics came {:.0f} ms {} those by force ({}), which replace them.",
                                        std::abs(1000 * strikes.mean_s), strikes.mean_s < 0 ? "before" : "after", strikes.count));
    }
    if (!measure_.ground.empty())
      sentences.push_back(
          fmt::format("The ground's force is in the walking direction, to the other foot, and upwards, of cycles whose "
                      "stance is one contact with a plate{}.",
                      measure_.mass_kg ? fmt::format("; the mass is {:.1f} kg", *measure_.mass_kg) : ""));
    if (!measure_.kinetics.source.empty()) sentences.push_back(measure_.kinetics.source);
    if (!measure_.muscles.empty())
      sentences.emplace_back("Muscles: rectified above 20 Hz, low-passed at 6 Hz, in the channel's unit.");
    if (measure_.reference && measure_.reference->curved > 0)
      sentences.push_back(fmt::format("Of the control group {} cycles that turn are omitted.", measure_.reference->curved));
    add_cycle_table();
    add_marker_tables();
  }

  /// Of each joint how many cycles are in its mean.
  void add_cycle_table() {
    draw::PageTable table{
        .title = "Cycles in the means", .head = {"angle", "left", "right", "omitted, left", "omitted, right"}, .rows = {}};
    table.bars_end = 0;
    table.cards = true;
    for (const gait::CycleCurve& curve : measure_.cycles.curves) {
      if (gait::side_of_curve(curve.name) != gait::Side::left) continue;
      const std::string_view name = gait::without_side(curve.name);
      const auto right = std::find_if(measure_.cycles.curves.begin(), measure_.cycles.curves.end(), [&](const auto& other) {
        return gait::side_of_curve(other.name) == gait::Side::right && gait::without_side(other.name) == name;
      });
      const std::size_t omitted = curve.unknown + curve.jumping;
      const std::size_t omitted_right = right->unknown + right->jumping;
      if (omitted + omitted_right == 0) continue;
      table.rows.push_back({in_words(name), fmt::format("{}", curve.cycles.size()), fmt::format("{}", right->cycles.size()),
                            fmt::format("{}", omitted), fmt::format("{}", omitted_right)});
    }
    if (table.rows.empty()) report_.quality.emplace_back("Every angle is known in every cycle.");
    report_.tables.push_back(std::move(table));
  }

  void add_marker_tables() {
    draw::PageTable gaps{.title = "Markers that are missing at times", .head = {"marker", "missing, %", "longest, s"}, .rows = {}};
    gaps.bars_end = 0;
    for (const GaitQuality::Gaps& one : measure_.quality.gaps)
      gaps.rows.push_back({one.marker, fmt::format("{:.1f}", 100 * one.missing_fraction), fmt::format("{:.2f}", one.longest_s)});
    report_.tables.push_back(std::move(gaps));
    draw::PageTable pairs{.title = "Distances within a segment, the least steady",
                          .head = {"markers", "distance, mm", "90 % of the walk within, mm", "walk − static trial, mm"},
                          .rows = {}};
    pairs.bars_end = 0;
    pairs.cards = true;
    for (std::size_t i = 0; i < std::min(kShownPairs, measure_.quality.pairs.size()); ++i) {
      const GaitQuality::Pair& pair = measure_.quality.pairs[i];
      pairs.rows.push_back({pair.first + " to " + pair.second, fmt::format("{:.0f}", 1000 * pair.distance_m),
                            fmt::format("{:.1f}", 1000 * pair.range_m),
                            pair.to_static_m ? fmt::format("{:+.1f}", 1000 * *pair.to_static_m) : std::string()});
    }
    report_.tables.push_back(std::move(pairs));
  }

  const std::string& recording_;
  const GaitMeasure& measure_;
  GaitReport report_;
};

}  // namespace

void write_gait_report(const std::string& path, const std::string& recording, const GaitMeasure& measure) {
  WholeFile file(path);
  file.write(draw::to_html(ReportOfWalk(recording, measure).make()));
  file.finish();
}

}  // namespace marey::pipeline::bodies
