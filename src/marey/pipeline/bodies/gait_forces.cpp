#include "marey/pipeline/bodies/gait_forces.h"

#include <array>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/files/whole_file.h"
#include "marey/format/recording_file.h"
#include "marey/format/register.h"
#include "marey/format/take/take_plates.h"

namespace marey::pipeline::bodies {
namespace {

constexpr std::array<const char*, 2> kForceSides = {"left", "right"};

void write_force_csv(const std::string& path, const gait::FootForces& forces, double begin_s) {
  WholeFile file(path);
  std::string text = "time_s";
  for (const char* side : kForceSides)
    text += fmt::format(
        ",{0}_force_x_n,{0}_force_y_n,{0}_force_z_n,{0}_pressure_x_m,{0}_pressure_y_m,{0}_pressure_z_m,{0}_free_moment_nm", side);
  text += '\n';
  for (std::size_t s = 0; s < forces.feet[0].size(); ++s) {
    fmt::format_to(std::back_inserter(text), "{:.6g}", begin_s + static_cast<double>(s) / forces.rate_hz);
    for (const auto& foot : forces.feet) {
      if (const auto& load = foot[s])
        fmt::format_to(std::back_inserter(text), ",{:.3f},{:.3f},{:.3f},{:.5f},{:.5f},{:.5f},{:.4f}", load->force.x(),
                       load->force.y(), load->force.z(), load->pressure.x(), load->pressure.y(), load->pressure.z(),
                       load->free_moment);
      else
        text += ",,,,,,,";
    }
    text += '\n';
  }
  file.write(text);
  file.finish();
}

/// Forces and moments about the world's origin are low-passed, and points follow: the loads' sum stays what it was.
void smooth(format::skeleton::ExternalLoad& load, double cutoff_hz, double rate_hz) {
  std::vector<Vector<3>> about_origin(load.forces.size());
  for (std::size_t s = 0; s < load.forces.size(); ++s) about_origin[s] = load.moments[s] + load.points[s].cross(load.forces[s]);
  for (std::vector<Vector<3>>* vectors : {&load.forces, &about_origin}) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      std::vector<double> along;
      for (const Vector<3>& vector : *vectors) along.push_back(vector[axis]);
      along = gait::low_pass(std::move(along), cutoff_hz, rate_hz);
      for (std::size_t s = 0; s < along.size(); ++s) (*vectors)[s][axis] = along[s];
    }
  }
  for (std::size_t s = 0; s < load.forces.size(); ++s) load.moments[s] = about_origin[s] - load.points[s].cross(load.forces[s]);
}

/// None if the recording is not a take, or has none.
format::motion::AnalogData plates_of_take(const std::string& recording) {
  format::motion::AnalogData analog;
  if (format::format_to_read(recording, format::Content::space).name != "take") return analog;
  analog.plates = format::take::read_plates(recording);
  if (analog.plates.empty()) return analog;
  analog.rate_hz = analog.plates.front().rate_hz;
  analog.begin_s = analog.plates.front().begin_s;
  return analog;
}

bool is_voltage(const std::string& unit) {
  return unit == "V" || unit == "mV" || unit == "uV" || unit == "µV" || unit == "\xB5V";
}

}  // namespace

format::motion::AnalogData read_plates(const std::string& recording, const GaitMarkers& markers, const std::string& plates) {
  if (plates.empty() && !markers.auxiliary.path.empty()) return format::motion::read_analog_data(markers.auxiliary);
  if (plates.empty()) return plates_of_take(recording);
  format::ReadOptions how;
  if (markers.up == format::UpAxis::y) how.up = markers.up;
  const auto reader = format::open_recording(plates, format::format_to_read(plates, format::Content::space), how);
  if (reader->info().auxiliary.channels == 0)
    throw Error("{}: has no force plates; a C3D file with analog channels is wanted", plates);
  if (std::abs(reader->header().rate_hz - markers.rate_hz) > 1e-6 * markers.rate_hz)
    throw Error("{}: has {:g} frames a second, and {} {:g}; force plates of the same walk are wanted", plates,
                reader->header().rate_hz, recording, markers.rate_hz);
  format::motion::AnalogData analog = format::motion::read_analog_data(reader->info().auxiliary);
  if (analog.plates.empty()) throw Error("{}: has no force plates", plates);
  const double end_s = analog.begin_s + static_cast<double>(analog.plates.front().loads.size()) / analog.rate_hz;
  const double walk_end_s = markers.begin_s + static_cast<double>(markers.rows.size()) / markers.rate_hz;
  if (end_s <= markers.begin_s || analog.begin_s >= walk_end_s)
    throw Error("{}: is from {:.2f} to {:.2f} s, and {} from {:.2f} to {:.2f} s: not of the same walk", plates, analog.begin_s,
                end_s, recording, markers.begin_s, walk_end_s);
  if (std::abs(end_s - walk_end_s) + std::abs(analog.begin_s - markers.begin_s) > 1 / markers.rate_hz + 1e-9)
    analog.warnings.push_back(
        fmt::format("{}: is from {:.2f} to {:.2f} s, and {} from {:.2f} to {:.2f} s; are they of the same walk?", plates,
                    analog.begin_s, end_s, recording, markers.begin_s, walk_end_s));
  return analog;
}

std::vector<gait::SignalCurve> emg_curves(const format::motion::AnalogData& analog, double begin_s,
                                          std::span<const gait::GaitCycles::Cycle> cycles) {
  std::vector<gait::SignalCurve> curves;
  for (const format::motion::AnalogChannel& channel : analog.channels) {
    const auto side = gait::side_of_label(channel.label);
    if (!side || !is_voltage(channel.unit)) continue;
    const std::vector<double> envelope = gait::emg_envelope(channel.values, analog.rate_hz);
    gait::SignalCurve curve =
        gait::signal_over_cycles(channel.label, *side, envelope, analog.rate_hz, analog.begin_s - begin_s, cycles);
    curve.unit = channel.unit;
    if (!curve.cycles.empty()) curves.push_back(std::move(curve));
  }
  return curves;
}

std::vector<format::skeleton::ExternalLoad> external_loads(const gait::FootForces& forces, double begin_s, const std::string& left,
                                                           const std::string& right, double cutoff_hz) {
  std::vector<format::skeleton::ExternalLoad> loads;
  for (std::size_t side = 0; side < 2; ++side) {
    format::skeleton::ExternalLoad load{.body = side == 0 ? left : right, .times = {}, .forces = {}, .points = {}, .moments = {}};
    Vector<3> point = Vector<3>::Zero();
    for (const auto& first : forces.feet[side]) {
      if (!first) continue;
      point = first->pressure;
      break;
    }
    for (std::size_t s = 0; s < forces.feet[side].size(); ++s) {
      const auto& foot = forces.feet[side][s];
      if (foot) point = foot->pressure;
      load.times.push_back(begin_s + static_cast<double>(s) / forces.rate_hz);
      load.forces.push_back(foot ? foot->force : Vector<3>(Vector<3>::Zero()));
      load.points.push_back(point);
      load.moments.emplace_back(0, 0, foot ? foot->free_moment : 0);
    }
    if (cutoff_hz > 0) smooth(load, cutoff_hz, forces.rate_hz);
    loads.push_back(std::move(load));
  }
  return loads;
}

void write_forces(const std::string& path, const gait::FootForces& forces, double begin_s) {
  if (path.ends_with(".csv")) return write_force_csv(path, forces, begin_s);
  format::skeleton::write_external_loads(path, external_loads(forces, begin_s, "calcn_l", "calcn_r", 0));
}

}  // namespace marey::pipeline::bodies
