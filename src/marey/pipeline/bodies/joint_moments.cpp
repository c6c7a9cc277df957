#include "marey/pipeline/bodies/joint_moments.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "marey/analyse/gait/foot_forces.h"
#include "marey/core/error.h"
#include "marey/format/motion/force_plates.h"
#include "marey/format/recording_file.h"
#include "marey/format/register.h"
#include "marey/format/skeleton/external_loads.h"
#include "marey/format/skeleton/motion_table.h"
#include "marey/format/skeleton/skeleton_file.h"
#include "marey/pipeline/bodies/gait_forces.h"

namespace marey::pipeline::bodies {
namespace {

constexpr double kMissingFraction = 0.1;  // by definition: of the weight
constexpr double kUneven = 0.01;          // numerical: of a frame
constexpr double kToeM = 0.18;            // from a heel's body to the toe, where the model has no toes; unswept

using solve::skeleton::CoordinateMotion;
using solve::skeleton::SegmentLoad;

/// First or second derivative of evenly spaced values: five points, three near the ends, and the nearest of those at the ends.
std::vector<double> derivative(const std::vector<double>& v, double rate_hz, int order) {
  const std::size_t n = v.size();
  std::vector<double> result(n, 0.0);
  if (n < 3) return result;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t c = std::clamp<std::size_t>(i, 1, n - 2);
    const bool five = c >= 2 && c + 2 < n;
    if (order == 1) {
      result[i] = five ? (v[c - 2] - 8 * v[c - 1] + 8 * v[c + 1] - v[c + 2]) / 12 : (v[c + 1] - v[c - 1]) / 2;
      if (i != c) result[i] += (i < c ? -1 : 1) * (v[c - 1] - 2 * v[c] + v[c + 1]);
    } else {
      result[i] = five ? (-v[c - 2] + 16 * v[c - 1] - 30 * v[c] + 16 * v[c + 1] - v[c + 2]) / 12 : v[c - 1] - 2 * v[c] + v[c + 1];
    }
    result[i] *= order == 1 ? rate_hz : rate_hz * rate_hz;
  }
  return result;
}

/// A model's motion with its derivatives, by coordinate and frame.
struct DynamicMotion {
  double rate_hz = 0;
  std::vector<double> times;
  std::vector<std::vector<double>> value, speed, acceleration;  // by coordinate

  CoordinateMotion at(std::size_t frame) const {
    CoordinateMotion motion;
    for (std::size_t c = 0; c < value.size(); ++c) {
      motion.value.push_back(value[c][frame]);
      motion.speed.push_back(speed[c][frame]);
      motion.acceleration.push_back(acceleration[c][frame]);
    }
    return motion;
  }
};

/// A column's values, in rad where the table has degrees; nothing if it is not there or has gaps.
std::optional<std::vector<double>> column_of(const format::skeleton::MotionTable& table, const std::string& name, double scale) {
  const auto found = std::find(table.columns.begin(), table.columns.end(), name);
  if (found == table.columns.end()) return std::nullopt;
  std::vector<double> values;
  for (const auto& row : table.rows) {
    const auto& cell = row[static_cast<std::size_t>(found - table.columns.begin())];
    if (!cell) return std::nullopt;
    values.push_back(*cell * scale);
  }
  return values;
}

DynamicMotion read_motion(const std::string& path, const Skeleton& skeleton, double cutoff_hz, std::vector<std::string>& warnings) {
  const format::skeleton::MotionTable table = format::skeleton::read_motion_table(path);
  const std::size_t frames = table.times.size();
  if (frames < 5) throw Error("{}: has {} frames; accelerations need 5", path, frames);
  DynamicMotion motion;
  motion.times = table.times;
  const double step = (table.times.back() - table.times.front()) / static_cast<double>(frames - 1);
  if (!(step > 0)) throw Error("{}: its times do not grow", path);
  motion.rate_hz = 1 / step;
  for (std::size_t r = 0; r < frames; ++r) {
    if (std::abs(table.times[r] - table.times.front() - static_cast<double>(r) * step) > kUneven * step + 1e-6)
      throw Error("{}: its times are uneven at {} s; frames at an even rate are wanted", path, table.times[r]);
  }
  std::vector<std::string> absent;
  for (const Coordinate& coordinate : skeleton.coordinates) {
    const double scale = coordinate.is_rotation && table.in_degrees.value_or(true) ? std::numbers::pi / 180 : 1;
    auto value = column_of(table, coordinate.name, scale);
    if (!value && !coordinate.coupling) absent.push_back(coordinate.name);
    const bool known = value.has_value();
    if (!value) value = std::vector<double>(frames, coordinate.rest);
    auto speed = column_of(table, coordinate.name + "/speed", scale),
         acceleration = column_of(table, coordinate.name + "/acceleration", scale);
    if (known && !(speed && acceleration) && cutoff_hz > 0) value = gait::low_pass(std::move(*value), cutoff_hz, motion.rate_hz);
    motion.speed.push_back(speed ? *speed : derivative(*value, motion.rate_hz, 1));
    motion.acceleration.push_back(acceleration ? *acceleration : derivative(*value, motion.rate_hz, 2));
    motion.value.push_back(std::move(*value));
  }
  if (!absent.empty())
    warnings.push_back(fmt::format("{}: {} of the model's coordinates are not in it, or have gaps, and rest: {}{}", path,
                                   absent.size(), absent.front(), absent.size() > 1 ? ", …" : ""));
  return motion;
}

/// Where heels and toes are, as the model's bodies have them.
gait::FeetPaths feet_of_model(const Skeleton& skeleton, const DynamicMotion& motion, const std::array<int, 2>& feet) {
  gait::FeetPaths paths;
  for (std::size_t frame = 0; frame < motion.times.size(); ++frame) {
    CoordinateMotion now = motion.at(frame);
    skeleton.couple(now.value);
    const std::vector<Rigid3> poses = pose_of(skeleton, now.value);
    for (std::size_t side = 0; side < 2; ++side) {
      const auto foot = static_cast<std::size_t>(feet[side]);
      Vector<3> toe = poses[foot] * Vector<3>(kToeM, 0, 0);
      for (std::size_t s = 0; s < skeleton.segments.size(); ++s) {
        if (skeleton.segments[s].parent == feet[side]) toe = poses[s].translation;
      }
      paths.heel[side].emplace_back(poses[foot].translation);
      paths.toe[side].emplace_back(toe);
    }
  }
  return paths;
}

int body_of_model(const Skeleton& skeleton, const std::string& model, const std::string& name) {
  const auto segment = skeleton.segment(name);
  if (!segment) throw Error("{}: has no body {}, on which a load acts; --left-foot and --right-foot name others", model, name);
  return *segment;
}

/// Loads on the feet by force plates. Forces are low-passed as the motion is, so that both have the same impacts.
std::vector<format::skeleton::ExternalLoad> plate_loads(const std::string& model, const Skeleton& skeleton,
                                                        const DynamicMotion& motion, const MomentOptions& options,
                                                        std::vector<std::string>& warnings) {
  const std::array<int, 2> feet = {body_of_model(skeleton, model, options.left_foot),
                                   body_of_model(skeleton, model, options.right_foot)};
  format::ReadOptions how;
  how.up = options.up;
  const auto reader = format::open_recording(options.loads, format::format_to_read(options.loads, format::Content::space), how);
  const format::motion::AnalogData analog = format::motion::read_analog_data(reader->info().auxiliary);
  if (analog.plates.empty()) throw Error("{}: has no force plates", options.loads);
  warnings.insert(warnings.end(), analog.warnings.begin(), analog.warnings.end());
  const gait::FootForces forces =
      gait::foot_forces(analog.plates, feet_of_model(skeleton, motion, feet), motion.rate_hz, motion.times.front());
  for (const std::string& warning : forces.warnings) warnings.push_back(fmt::format("{}: {}", options.loads, warning));
  return external_loads(forces, analog.begin_s, options.left_foot, options.right_foot, options.cutoff_hz);
}

Vector<3> interpolated(const std::vector<double>& times, const std::vector<Vector<3>>& values, double time) {
  const auto above = std::upper_bound(times.begin(), times.end(), time);
  if (above == times.begin()) return time < times.front() - 1e-9 ? Vector<3>(Vector<3>::Zero()) : values.front();
  const auto i = static_cast<std::size_t>(above - times.begin()) - 1;
  if (above == times.end()) return time > times.back() + 1e-9 ? Vector<3>(Vector<3>::Zero()) : values.back();
  const double fraction = (time - times[i]) / (times[i + 1] - times[i]);
  return (1 - fraction) * values[i] + fraction * values[i + 1];
}

/// What the root's shifts lack, in N.
void assess_residuals(const Skeleton& skeleton, JointMoments& moments) {
  std::vector<std::size_t> shifts;
  for (const JointAxis& axis : skeleton.segments.front().joint.axes) {
    if (!axis.is_rotation && axis.coordinate) shifts.push_back(static_cast<std::size_t>(*axis.coordinate));
  }
  if (shifts.size() != 3) return;
  double squares = 0, missing = 0;
  std::size_t explained = 0;
  for (std::size_t f = 0; f < moments.times.size(); ++f) {
    double square = 0;
    for (const std::size_t c : shifts) square += moments.coordinates[c].forces[f] * moments.coordinates[c].forces[f];
    if (std::sqrt(square) > kMissingFraction * moments.mass_kg * solve::skeleton::kGravity) {
      missing += 1;
    } else {
      squares += square;
      ++explained;
    }
  }
  if (explained > 0) moments.residual_n = std::sqrt(squares / static_cast<double>(explained));
  moments.unexplained_fraction = missing / static_cast<double>(moments.times.size());
}

void write_columns(const std::string& path, const JointMoments& moments, bool powers) {
  format::skeleton::MotionTable table{.title = powers ? "Joint powers" : "Inverse Dynamics Generalized Forces",
                                      .in_degrees = false,
                                      .columns = {},
                                      .times = moments.times,
                                      .rows = {}};
  table.rows.resize(moments.times.size());
  for (const JointMoments::Coordinate& coordinate : moments.coordinates) {
    table.columns.push_back(coordinate.name + (powers ? "_power" : coordinate.is_rotation ? "_moment" : "_force"));
    for (std::size_t f = 0; f < table.rows.size(); ++f)
      table.rows[f].emplace_back(powers ? coordinate.powers[f] : coordinate.forces[f]);
  }
  format::skeleton::write_motion_table(path, table);
}

}  // namespace

JointMoments joint_moments(const std::string& model, const std::string& motion_path, const MomentOptions& options,
                           const Hooks& hooks) {
  const format::skeleton::SkeletonFile file = format::skeleton::read_skeleton(model);
  const Skeleton& skeleton = file.skeleton;
  JointMoments moments;
  moments.warnings = file.warnings;
  for (const SegmentMass& mass : file.masses) moments.mass_kg += mass.mass_kg;
  if (!(moments.mass_kg > 0)) throw Error("{}: has no masses; an OpenSim model with them is wanted", model);
  const DynamicMotion motion = read_motion(motion_path, skeleton, options.cutoff_hz, moments.warnings);
  moments.rate_hz = motion.rate_hz;
  moments.times = motion.times;
  std::vector<format::skeleton::ExternalLoad> loads;
  if (!options.loads.empty())
    loads = options.loads.ends_with(".xml") ? format::skeleton::read_external_loads(options.loads)
                                            : plate_loads(model, skeleton, motion, options, moments.warnings);
  std::vector<int> bodies;
  for (const auto& load : loads) bodies.push_back(body_of_model(skeleton, model, load.body));
  for (const Coordinate& coordinate : skeleton.coordinates)
    moments.coordinates.push_back({coordinate.name, coordinate.is_rotation, {}, {}});
  for (std::size_t f = 0; f < motion.times.size(); ++f) {
    CoordinateMotion now = motion.at(f);
    couple(skeleton, now);
    std::vector<SegmentLoad> here;
    for (std::size_t l = 0; l < loads.size(); ++l)
      here.push_back({bodies[l], interpolated(loads[l].times, loads[l].forces, motion.times[f]),
                      interpolated(loads[l].times, loads[l].points, motion.times[f]),
                      interpolated(loads[l].times, loads[l].moments, motion.times[f])});
    const std::vector<double> forces = solve::skeleton::inverse_dynamics(skeleton, file.masses, now, here);
    for (std::size_t c = 0; c < forces.size(); ++c) {
      moments.coordinates[c].forces.push_back(forces[c]);
      moments.coordinates[c].powers.push_back(forces[c] * now.speed[c]);
    }
    hooks.advance({.step = "moments", .done = static_cast<std::int64_t>(f) + 1, .total = std::ssize(motion.times)});
  }
  assess_residuals(skeleton, moments);
  return moments;
}

void write_moments(const std::string& path, const JointMoments& moments) {
  write_columns(path, moments, false);
}

void write_powers(const std::string& path, const JointMoments& moments) {
  write_columns(path, moments, true);
}

}  // namespace marey::pipeline::bodies
