#include "marey/pipeline/bodies/gait_kinetics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/format/mapped_file.h"
#include "marey/format/motion/c3d.h"
#include "marey/format/motion/c3d_parameters.h"
#include "marey/format/motion/length_unit.h"
#include "marey/format/register.h"
#include "marey/format/skeleton/motion_table.h"

namespace marey::pipeline::bodies {
namespace {

namespace gait = analyse::gait;

constexpr double kEvenTimes = 1e-3;  // numerical: of a step, which six printed digits allow

/// Plug-in Gait's names: what is shown, the axis that has it, and what turns the file's number into the unit.
struct PluginKinetics {
  std::string_view label, title, unit;
  Eigen::Index axis;
  double scale;
};
constexpr std::array<PluginKinetics, 6> kPluginKinetics = {{{"HipMoment", "hip moment", "N m/kg", 0, 1e-3},
                                                            {"KneeMoment", "knee moment", "N m/kg", 0, 1e-3},
                                                            {"AnkleMoment", "ankle moment", "N m/kg", 0, 1e-3},
                                                            {"HipPower", "hip power", "W/kg", 2, 1},
                                                            {"KneePower", "knee power", "W/kg", 2, 1},
                                                            {"AnklePower", "ankle power", "W/kg", 2, 1}}};

/// All points of a C3D file under the labels asked for, as the file has the numbers, by row.
std::map<std::string, std::vector<std::optional<Vector<3>>>> points_in(const std::string& path, std::span<const std::string> labels,
                                                                       double metres_per_unit) {
  std::map<std::string, std::vector<std::optional<Vector<3>>>> points;
  std::map<TrackId, std::string> wanted;
  const auto reader = format::motion::open_c3d(path, format::motion::C3dPoints::all);
  for (const TrackName& name : reader->tracks()) {
    const std::string label = name.label.substr(name.label.find_last_of(':') + 1);
    if (std::find(labels.begin(), labels.end(), label) != labels.end()) wanted[name.id] = label;
  }
  if (wanted.empty()) return points;
  std::optional<std::int64_t> first;
  while (const auto instant = reader->next()) {
    if (!first) first = instant->index;
    const auto row = static_cast<std::size_t>(instant->index - *first);
    for (const Sample& sample : instant->samples) {
      const auto label = wanted.find(sample.track);
      if (label == wanted.end()) continue;
      auto& rows = points[label->second];
      rows.resize(row + 1);
      rows[row] = sample.position / metres_per_unit;
    }
  }
  return points;
}

/// "hip_flexion_l_moment" → hip flexion moment, of the left; nothing for what is not a leg's.
struct TableColumn {
  std::string title, unit;
  gait::Side side = gait::Side::left;
};
std::optional<TableColumn> column_named(std::string name, bool per_kg) {
  TableColumn column;
  bool power = false;
  if (name.ends_with("_moment")) {
    name.resize(name.size() - std::string_view("_moment").size());
  } else if (name.ends_with("_power")) {
    name.resize(name.size() - std::string_view("_power").size());
    power = true;
  } else {
    return std::nullopt;
  }
  if (!name.ends_with("_l") && !name.ends_with("_r")) return std::nullopt;
  column.side = name.ends_with("_l") ? gait::Side::left : gait::Side::right;
  name.resize(name.size() - 2);
  if (!name.starts_with("hip_") && !name.starts_with("knee_") && !name.starts_with("ankle_")) return std::nullopt;
  std::replace(name.begin(), name.end(), '_', ' ');
  column.title = name + (power ? " power" : " moment");
  column.unit = power ? "W" : "N m";
  if (per_kg) column.unit += "/kg";
  return column;
}

/// Samples per second of a table. Throws Error if its times are uneven.
double rate_of(const format::skeleton::MotionTable& table, const std::string& path) {
  if (table.times.size() < 2) throw Error("{}: has {} rows; moments of a walk are wanted", path, table.times.size());
  const double step = (table.times.back() - table.times.front()) / static_cast<double>(table.times.size() - 1);
  for (std::size_t r = 0; r < table.times.size(); ++r) {
    if (std::abs(table.times[r] - table.times.front() - step * static_cast<double>(r)) > std::max(kEvenTimes * step, 1e-5))
      throw Error("{}: its times are not even at row {}; write it at an even rate", path, r + 1);
  }
  if (!(step > 0)) throw Error("{}: its times do not increase", path);
  return 1 / step;
}

}  // namespace

GaitKinetics kinetics_in_c3d(const std::string& recording, double rate_hz, std::span<const gait::GaitCycles::Cycle> cycles) {
  GaitKinetics kinetics;
  if (cycles.empty() || format::format_to_read(recording, format::Content::space).name != "c3d") return kinetics;
  const format::MappedFile file(recording);
  const auto head = format::motion::read_c3d_head(file.bytes(), recording);
  // Plug-in Gait writes moments in N mm per kg of the body, and calls the unit Nmm. Another unit is another program's.
  if (head.text("POINT:MOMENT_UNITS") != "Nmm") return kinetics;
  std::vector<std::string> labels;
  for (const char side : {'L', 'R'}) {
    for (const PluginKinetics& one : kPluginKinetics) labels.push_back(std::string(1, side).append(one.label));
  }
  const auto points = points_in(recording, labels, format::motion::metres_of_unit(head.text("POINT:UNITS")).value_or(1e-3));
  for (const gait::Side side : gait::kSides) {
    for (const PluginKinetics& one : kPluginKinetics) {
      const auto found = points.find((side == gait::Side::left ? "L" : "R") + std::string(one.label));
      if (found == points.end()) continue;
      std::vector<std::optional<double>> signal;
      for (const auto& row : found->second) signal.push_back(row ? std::optional(one.scale * (*row)[one.axis]) : std::nullopt);
      gait::SignalCurve curve =
          gait::signal_over_cycles(std::string(one.title), side, std::span(std::as_const(signal)), rate_hz, 0, cycles);
      curve.unit = one.unit;
      if (!curve.cycles.empty()) kinetics.curves.push_back(std::move(curve));
    }
  }
  if (!kinetics.curves.empty()) kinetics.source = "Moments and powers are those of the C3D file (Plug-in Gait), with its signs.";
  return kinetics;
}

GaitKinetics kinetics_in_tables(std::span<const std::string> paths, double begin_s, std::optional<double> mass_kg,
                                std::span<const gait::GaitCycles::Cycle> cycles) {
  GaitKinetics kinetics;
  for (const std::string& path : paths) {
    const format::skeleton::MotionTable table = format::skeleton::read_motion_table(path);
    const double rate_hz = rate_of(table, path);
    bool any = false;
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      const auto column = column_named(table.columns[c], mass_kg.has_value());
      if (!column) continue;
      any = true;
      std::vector<std::optional<double>> signal;
      for (const auto& row : table.rows) signal.push_back(row[c] ? std::optional(*row[c] / mass_kg.value_or(1)) : std::nullopt);
      gait::SignalCurve curve = gait::signal_over_cycles(column->title, column->side, std::span(std::as_const(signal)), rate_hz,
                                                         table.times.front() - begin_s, cycles);
      curve.unit = column->unit;
      if (!curve.cycles.empty()) kinetics.curves.push_back(std::move(curve));
    }
    if (!any)
      throw Error("{}: has no column of a leg's moment or power (hip_flexion_l_moment, …); what marey moments writes is wanted",
                  path);
    if (kinetics.curves.empty() && !cycles.empty())
      throw Error("{}: is from {:.2f} to {:.2f} s and holds no whole gait cycle of the walk: not of the same walk?", path,
                  table.times.front(), table.times.back());
    const std::string name = std::filesystem::path(path).filename().string();
    kinetics.source += (kinetics.source.empty() ? "Moments and powers are those of " : ", ") + name;
  }
  if (!kinetics.source.empty()) kinetics.source += '.';
  return kinetics;
}

}  // namespace marey::pipeline::bodies
