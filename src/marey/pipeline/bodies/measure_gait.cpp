#include "marey/pipeline/bodies/measure_gait.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "marey/analyse/gait/emg_envelope.h"
#include "marey/analyse/gait/force_curves.h"
#include "marey/core/error.h"
#include "marey/files/whole_file.h"
#include "marey/pipeline/bodies/body_proportions.h"
#include "marey/pipeline/bodies/gait_c3d.h"
#include "marey/pipeline/bodies/gait_forces.h"
#include "marey/pipeline/bodies/gait_markers.h"
#include "marey/pipeline/bodies/gait_pages.h"

namespace marey::pipeline::bodies {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr double kMaxStandingFlexion = 20 * std::numbers::pi / 180;  // rad: bench/tuning.md
constexpr double kStandardGravity = 9.80665;                         // m/s², by definition

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
    if (std::none_of(feet.sacrum.begin(), feet.sacrum.end(), [](const auto& location) { return location.has_value(); }))
      feet.sacrum = markers.path(other);
  }
  return feet;
}

/// "Voltage.L Rect": what a table can hold without quotes.
std::string csv_name(std::string text) {
  std::replace_if(text.begin(), text.end(), [](char c) { return c == ',' || c == '"' || c == '\n'; }, '_');
  return text;
}

/// Muscles' curves have their file's unit where angles have degrees.
void write_cycles(const std::string& path, const gait::GaitCycles& cycles, std::span<const gait::SignalCurve> muscles) {
  WholeFile file(path);
  std::string text = "angle,percent,mean_deg,deviation_deg,cycles\n";
  for (const gait::CycleCurve& curve : cycles.curves) {
    if (curve.cycles.empty()) continue;
    for (std::size_t p = 0; p < gait::kCyclePoints; ++p)
      fmt::format_to(std::back_inserter(text), "{},{},{:.4f},{:.4f},{}\n", curve.name, p, curve.mean[p] * kDegrees,
                     curve.deviation[p] * kDegrees, curve.cycles.size());
  }
  for (const gait::SignalCurve& curve : muscles) {
    for (std::size_t p = 0; p < gait::kCyclePoints; ++p)
      fmt::format_to(std::back_inserter(text), "emg_{},{},{:.6g},{:.6g},{}\n", csv_name(curve.label), p, curve.mean[p],
                     curve.deviation[p], curve.cycles.size());
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

/// "left shoulder plane, left shoulder rotation", and how many more.
std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kMostNamed = 4;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kMostNamed); ++i) text.append(i == 0 ? "" : ", ").append(names[i]);
  std::replace(text.begin(), text.end(), '_', ' ');
  return names.size() > kMostNamed ? fmt::format("{} and {} more", text, names.size() - kMostNamed) : text;
}

/// Rows in which an arm hangs down: it is known how far it is raised, and not in which plane.
std::int64_t hanging_rows(const GaitMeasure& measure, const gait::AngleCurve& curve) {
  const std::size_t shoulder = curve.name.find("shoulder_");
  if (shoulder == std::string::npos) return 0;
  const std::string raised = curve.name.substr(0, shoulder) + "shoulder_elevation";
  const auto elevation =
      std::find_if(measure.angles.begin(), measure.angles.end(), [&](const auto& c) { return c.name == raised; });
  std::int64_t rows = 0;
  for (std::size_t r = 0; elevation != measure.angles.end() && r < curve.values.size(); ++r)
    rows += !curve.values[r] && elevation->values[r] ? 1 : 0;
  return rows;
}

/// Which angles are not known at some time, or omitted of the cycles' mean; those that share their reason in one sentence.
void warn_of_gaps(const std::string& recording, GaitMeasure& measure) {
  std::map<std::string, std::vector<std::string>> names_by_reason;
  for (std::size_t a = 0; a < measure.angles.size(); ++a) {
    const gait::AngleCurve& curve = measure.angles[a];
    const gait::CycleCurve& over_cycle = measure.cycles.curves[a];
    const auto unknown = std::count(curve.values.begin(), curve.values.end(), std::nullopt);
    std::string reason;
    if (unknown == std::ssize(curve.values)) {
      reason = "never known: markers are missing";
    } else if (unknown > 0) {
      const std::int64_t hanging = hanging_rows(measure, curve);
      const char* why = hanging == 0         ? "markers are missing"
                        : hanging == unknown ? "an arm that hangs down has no plane"
                                             : "markers are missing, or the arm hangs down and has no plane";
      reason = fmt::format("not known for {:.2f} of {:.2f} s ({})", static_cast<double>(unknown) / measure.rate_hz,
                           static_cast<double>(measure.frames) / measure.rate_hz, why);
    }
    if (over_cycle.jumping > 0) reason.append(reason.empty() ? "" : ", ").append("jumps by more than 90° between two frames");
    const std::size_t excluded = over_cycle.unknown + over_cycle.jumping;
    if (excluded > 0 && unknown < std::ssize(curve.values))
      reason += fmt::format("; omitted of the mean: {} of {} cycles", excluded, excluded + over_cycle.cycles.size());
    if (!reason.empty()) names_by_reason[reason].push_back(curve.name);
  }
  for (const auto& [reason, names] : names_by_reason)
    measure.warnings.push_back(fmt::format("{}: {}: {}", recording, listed(names), reason));
}

/// Throws Error if nothing of a walk is left to be reported.
void need_steps(const std::string& recording, const GaitMeasure& measure, const GaitOutput& output) {
  if (!measure.events.empty()) return;
  const char* hint = measure.lies            ? "; it lies, by the --up that was given: is that right?"
                     : output.angles.empty() ? "; --angles writes the angles of one who does not"
                                             : "; --angles alone does not ask for any";
  throw Error("{}: no steps were found: HEE and TOE of a side are needed, and a person who walks{}", recording, hint);
}

/// Throws Error if the pelvis' up is the recording's other axis, which was not said. Where it lies across the up that was said,
/// that is returned, to be reported: the person may lie down.
std::optional<std::string> up_across(const std::string& recording, const std::optional<format::UpAxis>& stated,
                                     const GaitMarkers& markers, const gait::GaitSubject& subject) {
  constexpr double kMostly = 0.8;  // cosine
  Vector<3> up = Vector<3>::Zero();
  for (const gait::MarkerPositions& row : markers.rows) {
    if (const auto pelvis = gait::pose_of(row, subject)[gait::SegmentId::pelvis]) up += pelvis->rotation.col(2);
  }
  if (!(up.norm() > 0)) return std::nullopt;
  // A file's y is z here where its y was taken for up, and its z is then −y.
  const bool y = markers.up == format::UpAxis::y;
  const char *taken = y ? "y" : "z", *there = y ? "z" : "y";
  if (!((y ? -1 : 1) * up.normalized().y() > kMostly)) return std::nullopt;
  if (!stated)
    throw Error("{}: {} was taken for up, and the person's up is along {}: give --up {} (or --up {}, if it lies down)", recording,
                taken, there, there, taken);
  return fmt::format("{}: --up {} was given, and the person's up is along {}: does it lie down?", recording, taken, there);
}

/// Loads of force plates, and their events in place of those by kinematics.
void add_forces(const format::motion::AnalogData& analog, const gait::FeetPaths& feet, const std::string& recording,
                GaitMeasure& measure) {
  measure.warnings.insert(measure.warnings.end(), analog.warnings.begin(), analog.warnings.end());
  measure.forces = gait::foot_forces(analog.plates, feet, measure.rate_hz, measure.begin_s);
  measure.forces_begin_s = analog.begin_s;
  for (const std::string& warning : measure.forces.warnings) measure.warnings.push_back(fmt::format("{}: {}", recording, warning));
  measure.by_force = gait::prefer_forces(measure.events, measure.forces.events);
  measure.events = measure.by_force.events;
}

/// A static trial with bent knees: legs' lengths and the feet's neutral position are of that posture.
void warn_of_crouch(const gait::MarkerPositions& standing, const std::string& path, GaitMeasure& measure) {
  const auto angles = gait::angles_of(gait::pose_of(standing, measure.subject), Vector<2>::UnitX());
  for (std::size_t a = 0; a < angles.size(); ++a) {
    const std::string& name = gait::angle_names()[a];
    if (!name.ends_with("_knee_flexion") || !angles[a] || *angles[a] < kMaxStandingFlexion) continue;
    measure.warnings.push_back(
        fmt::format("{}: the {} knee is bent by {:.0f}° in the static trial; does the person stand in a crouch? "
                    "Hips' centres follow from legs' lengths, which are too short then: give --leg-length",
                    path, gait::side_of_curve(name) == gait::Side::left ? "left" : "right", *angles[a] * kDegrees));
  }
}

/// Forces, moments and powers over those cycles whose stance is on a plate.
void add_kinetics(const std::string& recording, const gait::FeetPaths& feet, const GaitOptions& options, GaitMeasure& measure) {
  const std::vector<gait::GaitCycles::Cycle> on_plates = gait::cycles_on_plates(measure.forces, measure.cycles.cycles);
  const BodySize size = body_size_in_c3d(recording);
  measure.mass_kg = options.mass_kg ? options.mass_kg : size.mass_kg;
  if (const double index = size.height_m ? body_mass_index(measure.mass_kg.value_or(0), *size.height_m) : 0;
      index > 0 && !is_persons_index(index))
    measure.warnings.push_back(
        fmt::format("{}: {:g} kg at a height of {:.2f} m are not a person's (body mass index {:.1f}); forces in % "
                    "of weight and moments per kg are wrong by as much",
                    recording, *measure.mass_kg, *size.height_m, index));
  measure.ground = gait::ground_reaction_curves(measure.forces, measure.forces_begin_s - measure.begin_s, measure.cycles.cycles,
                                                feet.sacrum, measure.rate_hz);
  if (measure.mass_kg) {
    for (gait::SignalCurve& curve : measure.ground) {
      const double per_cent = 100 / (*measure.mass_kg * kStandardGravity);
      curve.unit = gait::kPercentOfWeight;
      for (auto& cycle : curve.cycles) {
        for (double& value : cycle) value *= per_cent;
      }
      gait::summarise(curve.cycles, curve.mean, curve.deviation);
    }
  }
  if (options.joint_moments.empty()) {
    measure.kinetics = kinetics_in_c3d(recording, measure.rate_hz, on_plates);
  } else {
    measure.kinetics = kinetics_in_tables(options.joint_moments, measure.begin_s, measure.mass_kg,
                                          measure.forces.feet[0].empty() ? measure.cycles.cycles : on_plates);
  }
}

/// Who turns is not described by means over cycles.
void warn_of_curves(const std::string& recording, GaitMeasure& measure) {
  const auto turning = std::count_if(measure.cycles.cycles.begin(), measure.cycles.cycles.end(),
                                     [](const auto& cycle) { return cycle.turn && std::abs(*cycle.turn) > max_reference_turn(); });
  if (turning == 0) return;
  measure.warnings.push_back(
      fmt::format("{}: {} of {} cycles turn by more than {:.0f}°; step width, foot angles and differences of left and right are of "
                  "a turn, not of straight "
                  "walking{}",
                  recording, turning, measure.cycles.cycles.size(), max_reference_turn() * kDegrees,
                  measure.reference ? ", which alone the reference has" : ""));
}

/// The control group and the earlier session.
void add_comparison(const std::string& recording, const GaitOptions& options, const Hooks& hooks, GaitMeasure& measure) {
  if (!options.reference.empty()) {
    measure.reference = read_gait_reference(options.reference, options, hooks);
    const GaitReference& group = *measure.reference;
    measure.warnings.insert(measure.warnings.end(), group.warnings.begin(), group.warnings.end());
    if (const auto walker = walker_in_reference(options.reference, recording))
      measure.warnings.push_back(
          fmt::format("{}: the walker is {} of {}, too; a person who counts in the group lies nearer to its mean than one who does "
                      "not: take that folder out of the reference",
                      recording, *walker, options.reference));
    measure.profile = gait::gait_profile(measure.cycles.curves, group.bands);
  }
  warn_of_curves(recording, measure);
  if (options.before.empty()) return;
  GaitOptions earlier = options;
  earlier.before.clear();
  earlier.reference.clear();
  earlier.plates.clear();
  earlier.joint_moments.clear();
  earlier.static_trial = options.before_static;
  auto before = std::make_shared<GaitMeasure>(measure_gait(options.before, earlier, {.stop = hooks.stop}));
  if (before->cycles.cycles.empty()) throw Error("{}: no whole gait cycle was found in the earlier session", options.before);
  if (measure.reference) before->profile = gait::gait_profile(before->cycles.curves, measure.reference->bands);
  measure.warnings.insert(measure.warnings.end(), before->warnings.begin(), before->warnings.end());
  measure.before_name = options.before;
  measure.before = std::move(before);
}

void need_a_cycle(const std::string& recording, const GaitMeasure& measure, const GaitOutput& output) {
  need_steps(recording, measure, output);
  if (std::any_of(measure.cycles.curves.begin(), measure.cycles.curves.end(), [](const auto& c) { return !c.cycles.empty(); }))
    return;
  if (!measure.cycles.cycles.empty()) throw Error("{}: no angle is known over a whole gait cycle: markers are missing", recording);
  throw Error(
      "{}: no gait cycle was found, from a foot's strike to its next within 0.4 to 3 s: HEE and TOE of a side are needed, and a "
      "walk",
      recording);
}

/// The person's measures, from the files and the static trial; the markers of that trial, empty without one.
gait::MarkerPositions learn_person(const std::string& recording, const GaitMarkers& markers, const GaitOptions& options,
                                   const Hooks& hooks, GaitMeasure& measure) {
  take_measures(recording, measure.subject);
  gait::MarkerPositions standing;
  if (!options.static_trial.empty()) {
    take_measures(options.static_trial, measure.subject);
    standing = standing_positions(read_gait_markers(options.static_trial, options.up, hooks), options.static_trial);
    if (const auto pair = other_person(standing, markers))
      measure.warnings.push_back(
          fmt::format("{}: {}: another person's static trial, or markers that were put on again?", options.static_trial, *pair));
    measure.subject.learn_from(standing);
    warn_of_crouch(standing, options.static_trial, measure);
  } else {
    if (!measure.subject.leg_length[0] && !markers.rows.empty()) measure.subject.learn_from(markers.rows.front());
    measure.warnings.push_back(
        fmt::format("{}: no static trial, so that the ankles' zero is the line from ankle to toe", recording));
    measure.subject.sole_from_ankle_toe = options.subject.sole_from_ankle_toe;
  }
  take_soles(recording, measure.subject);
  return standing;
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
  measure.first_index = markers.first_index;
  const gait::MarkerPositions standing = learn_person(recording, markers, options, hooks, measure);
  measure.quality = gait_quality(markers, standing);
  if (auto across = up_across(recording, options.up, markers, measure.subject)) {
    measure.lies = true;
    measure.warnings.push_back(std::move(*across));
  }
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
  const format::motion::AnalogData analog = read_plates(recording, markers, options.plates);
  add_forces(analog, feet, recording, measure);
  if (measure.events.empty())
    measure.warnings.push_back(fmt::format("{}: no steps were found: HEE and TOE of a side are needed, and a walk", recording));
  measure.cycles = gait::gait_cycles(measure.events, measure.angles, feet, measure.rate_hz, options.cycles);
  measure.muscles = emg_curves(analog, measure.begin_s, measure.cycles.cycles);
  add_kinetics(recording, feet, options, measure);
  warn_of_gaps(recording, measure);
  add_comparison(recording, options, hooks, measure);
  return measure;
}

GaitMeasure measure_gait(const std::string& recording, const GaitOutput& output, const GaitOptions& options, const Hooks& hooks) {
  GaitMeasure measure = measure_gait(recording, options, hooks);
  if (output.angles.empty() && output.c3d.empty() && output.forces.empty()) need_steps(recording, measure, output);
  if (!output.forces.empty() && measure.forces.feet[0].empty())
    throw Error("{}: has no force plates; --plates names a C3D file of the same walk that has them", recording);
  if (!output.forces.empty()) write_forces(output.forces, measure.forces, measure.forces_begin_s);
  if (!output.angles.empty()) write_angles(output.angles, measure);
  if (!output.c3d.empty()) write_gait_c3d(output.c3d, recording, options.up, measure);
  if (!output.cycles.empty() || !output.report.empty()) need_a_cycle(recording, measure, output);
  if (!output.cycles.empty()) write_cycles(output.cycles, measure.cycles, measure.muscles);
  if (!output.report.empty()) write_gait_report(output.report, recording, measure);
  return measure;
}

}  // namespace marey::pipeline::bodies
