#include "marey/pipeline/bodies/solve_skeleton.h"

#include <algorithm>
#include <initializer_list>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "marey/core/error.h"
#include "marey/files/whole_file.h"
#include "marey/format/input_hash.h"
#include "marey/format/recording_file.h"
#include "marey/format/register.h"
#include "marey/format/skeleton/gltf.h"
#include "marey/format/skeleton/motion_table.h"
#include "marey/geometry/median.h"
#include "marey/pipeline/bodies/calibrate_skeleton.h"
#include "marey/pipeline/bodies/gait_markers.h"
#include "marey/pipeline/bodies/solve_counts.h"
#include "marey/pipeline/keypoints/keypoint_skeleton.h"
#include "marey/pipeline/markers/skeleton_in_space.h"
#include "marey/solve/skeleton/calibrate.h"
#include "marey/solve/skeleton/smooth.h"
#include "marey/solve/skeleton/whole.h"

namespace marey::pipeline::bodies {
namespace {

using format::Content;
using format::UpAxis;
constexpr double kKeypointSigma_m = 0.02, kKeypointRobust_m = 0.15, kKeypointLost_m = 0.4;  // unswept
constexpr std::int64_t kAppearanceAtPerson = 2000;  // rows by which it is reported whether the static trial is another's

bool ends_with_any(const std::string& path, std::initializer_list<std::string_view> endings) {
  return std::any_of(endings.begin(), endings.end(), [&](std::string_view ending) { return path.ends_with(ending); });
}

/// The frames together: the direction limbs bend, and where it is asked for the second pass. Statements on the motion are then of
/// the new one.
void solve_again(SolvedRecording& solved, const std::vector<solve::skeleton::ObservedMarkers>& detected,
                 const SolveOptions& options, SolveCounts& counts) {
  const double rate_hz = solved.motion.rate_hz;
  const std::vector<bool> settled =
      solve::skeleton::settle_folds(solved.skeleton, solved.motion.rows, detected, rate_hz, options.pose);
  const bool any = std::find(settled.begin(), settled.end(), true) != settled.end();
  if (!any && !options.smooth) return;
  if (options.smooth) solved.motion.rows = solve::skeleton::smooth(solved.skeleton, solved.motion.rows, detected, rate_hz);
  counts.restart();
  solve::skeleton::PoseSolver assess(solved.skeleton, options.pose);
  assess.learn_noise_of(solved.motion.rows, detected);
  for (std::size_t f = 0; f < detected.size(); ++f) {
    const auto& pose = assess.inspect_at(solved.motion.rows[f], detected[f]);
    counts.add(pose);
    solved.observed[f] = pose.observed;
    solved.residual_m[f] = pose.rms_m;
  }
}

/// The given up axis of the recording; nothing: as its file states.
std::optional<UpAxis> up_of(const format::Format& format, const std::string& skeleton, const SolveOptions& options) {
  if (!options.up && format.name == "trc" && skeleton.ends_with(".osim")) return UpAxis::y;
  return options.up;
}

/// The recording again, with its bodies, into a sink.
void replay_with_bodies(const std::string& recording, const SolvedRecording& solved, const SolveOptions& options,
                        const MadeBy& made_by, Sink& sink) {
  const auto reader = open_markers(recording, options);
  RecordingHeader header = reader->header();
  header.made_by = made_by;
  header.bodies = bodies_of(solved.skeleton);
  const std::vector<Matrix<3>> rest = rest_of(solved.skeleton);
  sink.begin(header);
  std::size_t row = 0;
  while (auto instant = reader->next()) {
    if (row >= solved.motion.rows.size()) break;
    if (row == 0) instant->named = reader->tracks();
    instant->bodies = markers::segment_poses(solved.skeleton, header.bodies, rest, solved.motion.rows[row], solved.observed[row],
                                             solved.residual_m[row]);
    ++row;
    sink.write(*instant);
  }
  sink.finish();
}

/// Says what the file could not hold of what stands beside the recording's points.
std::optional<std::string> write_output(const std::string& path, const std::string& recording, const SolvedRecording& solved,
                                        const SolveOptions& options, const MadeBy& made_by) {
  if (ends_with_any(path, {".mot", ".sto"})) {
    format::skeleton::write_motion_table(path, solved.skeleton, solved.motion);
    return std::nullopt;
  }
  if (format::skeleton::is_bone_file(path)) {
    const auto sink = format::skeleton::create_bones(path, options.bones);
    replay_with_bodies(recording, solved, options, made_by, *sink);
    return std::nullopt;
  }
  const format::Format& format = format::format_to_write(path, "", Content::space);
  format::WritePlan plan = format::plan_of(*open_markers(recording, options), recording);
  plan.info.header.made_by = made_by;
  plan.info.header.bodies = bodies_of(solved.skeleton);
  replay_with_bodies(recording, solved, options, made_by, *format::create_recording(path, format, plan));
  return format::auxiliary_lost(plan.info.auxiliary, path, format);
}

}  // namespace

void check_skeleton_output(const std::string& path) {
  if (ends_with_any(path, {".mot", ".sto", ".bvh", ".glb"})) return;
  try {
    format::format_to_write(path, "", Content::space);
  } catch (const format::WrongFormat&) {
    throw format::WrongFormat(
        "{}: unknown ending; a solved skeleton is written as .mot or .sto (angles), .bvh or .glb (bones), or with the markers as "
        "{}",
        path, format::endings_of_written(Content::space));
  }
}

SolvedRecording solve_recording(const std::string& recording, const format::skeleton::SkeletonFile& file,
                                const SolveOptions& options, const Hooks& hooks) {
  SolvedRecording solved;
  solved.skeleton = file.skeleton;
  SolveSummary& summary = solved.summary;
  summary.warnings = file.warnings;
  summary.skeleton = file.skeleton.name;
  summary.unused = file.unused;
  const auto reader = open_markers(recording, options);
  solved.motion.rate_hz = summary.rate_hz = reader->header().rate_hz;
  markers::SkeletonInSpace solver(std::make_shared<const Skeleton>(file.skeleton), solved.motion.rate_hz, options.pose,
                                  options.exclude);
  solver.name(reader->tracks());
  SolveCounts counts(solved.skeleton);
  std::vector<solve::skeleton::ObservedMarkers> all;
  while (const auto instant = reader->next()) {
    const auto& pose = solver.solve(*instant);
    counts.add(pose);
    solved.motion.times.push_back(instant->time);
    solved.motion.rows.push_back(pose.coordinates);
    solved.observed.push_back(pose.observed);
    solved.residual_m.push_back(pose.rms_m);
    all.push_back(solver.detected());
    if (hooks.report({.step = "solving", .done = ++summary.frames, .total = reader->instant_count()}) == Continue::no) {
      summary.stopped = true;
      break;
    }
  }
  const markers::SkeletonMarkers& labels = solver.markers();
  if (!labels.any()) throw Error("{}: {}", recording, labels.none_known(solved.skeleton.name));
  if (!summary.stopped) solve_again(solved, all, options, counts);
  for (const std::string& warning : reader->warnings()) summary.warnings.push_back(warning);
  summary.not_recorded = labels.not_recorded();
  summary.not_known = labels.unknown();
  if (summary.frames > 1) summary.seconds = seconds(solved.motion.times.back() - solved.motion.times.front());
  counts.write(solved.motion, summary);
  return solved;
}

namespace {

/// The human skeleton of who moves in the recording. Throws Error, with what else there is, where its markers are not set.
HumanSkeleton human_of_motion(const std::string& recording, const HumanOptions& how, const Hooks& hooks) {
  try {
    return human_from_motion(recording, how, hooks);
  } catch (const Error& error) {
    throw Error(
        "{}; so a skeleton is wanted: --skeleton FILE, or --static-trial of the person standing with a marker set of the field",
        error.what());
  }
}

/// The skeleton of a person whose body keypoints are recorded; nothing if none are.
std::optional<format::skeleton::SkeletonFile> skeleton_by_keypoints(const std::string& recording, SolveOptions& options) {
  const auto reader = open_markers(recording, options);
  const std::vector<std::string> people = keypoints::people_with_keypoints(reader->tracks());
  if (people.empty()) return std::nullopt;
  std::vector<std::string> names;
  for (const std::string& prefix : people) names.push_back(prefix.substr(0, prefix.find(':')));
  const auto found = options.person.empty() ? names.begin() : std::find(names.begin(), names.end(), options.person);
  if (found == names.end() && names.front().empty())
    throw Error("{}: has the keypoints of one person, without a name; remove --person", recording);
  if (found == names.end())
    throw Error("{}: has no keypoints of a person {}; there are {}", recording, options.person, fmt::join(names, ", "));
  format::skeleton::SkeletonFile file;
  file.skeleton = keypoints::skeleton_of_keypoints(read_all(*reader), people[static_cast<std::size_t>(found - names.begin())]);
  if (people.size() > 1 && options.person.empty())
    file.warnings.push_back(
        fmt::format("{}: has keypoints of {}; {} is solved, the others with --person", recording, fmt::join(names, ", "), *found));
  // A network's points lie farther off than markers do.
  options.pose.marker_sigma_m = kKeypointSigma_m;
  options.pose.robust_m = kKeypointRobust_m;
  options.pose.lost_m = kKeypointLost_m;
  return file;
}

format::skeleton::SkeletonFile skeleton_of(const std::string& recording, const std::string& skeleton, SolveOptions& options,
                                           SolveSummary& found, const Hooks& hooks) {
  if (!skeleton.empty()) {
    format::skeleton::SkeletonFile file = format::skeleton::read_skeleton(skeleton, options.read_skeleton);
    if (file.skeleton.name.empty()) file.skeleton.name = skeleton;
    return markers::with_a_marker_a_joint(std::move(file));
  }
  if (options.static_trial.empty()) {
    if (auto by_keypoints = skeleton_by_keypoints(recording, options)) return std::move(*by_keypoints);
    options.calibrate = true;
  }
  format::skeleton::SkeletonFile file;
  const HumanOptions how{.motion = options.motion, .marker_set = options.marker_set, .up = options.up};
  HumanSkeleton human =
      options.static_trial.empty() ? human_of_motion(recording, how, hooks) : human_from_static(options.static_trial, how, hooks);
  file.skeleton = std::move(human.skeleton);
  file.warnings = std::move(human.warnings);
  if (!options.static_trial.empty()) {
    const GaitMarkers moving = read_gait_markers(recording, options.up, hooks, *human.set, kAppearanceAtPerson);
    if (const auto other = other_person(human.standing, moving))
      file.warnings.push_back(fmt::format("{}: {}: another person's static trial than {}, or markers that were put on again?",
                                          options.static_trial, *other, recording));
  }
  found.joints = std::move(human.joints);
  found.marker_set = std::move(human.marker_set);
  return file;
}

/// Where the skeleton's up is mostly the recording's other axis: that one is up, unless the person lies down.
std::optional<std::string> lies_on_its_side(const SolvedRecording& solved, UpAxis taken, bool stated,
                                            const std::string& recording) {
  constexpr std::size_t kAppearance = 64;
  constexpr double kMostly = 0.8;  // cosine
  const auto& rows = solved.motion.rows;
  if (rows.empty()) return std::nullopt;
  const Matrix<3> rest = pose_of(solved.skeleton, solved.skeleton.rest()).front().rotation;
  Vector<3> up = Vector<3>::Zero();
  for (std::size_t r = 0; r < rows.size(); r += std::max<std::size_t>(1, rows.size() / kAppearance))
    up += (pose_of(solved.skeleton, rows[r]).front().rotation * rest.transpose()).col(2);
  // A file's y is z here where its y was taken for up, and its z is then −y.
  const double other = taken == UpAxis::z ? up.normalized().y() : -up.normalized().y();
  if (!(other > kMostly)) return std::nullopt;
  const char *named = taken == UpAxis::z ? "z" : "y", *there = taken == UpAxis::z ? "y" : "z";
  if (stated)
    return fmt::format("{}: --up {} was given, and the skeleton's up is along {}: does the person lie down?", recording, named,
                       there);
  return fmt::format("{}: {} was taken for up, and the skeleton's up is along {}: is {} up in this file? then give --up {}",
                     recording, named, there, there, there);
}

}  // namespace

SolvedRecording solve_with_skeleton(const std::string& recording, const std::string& skeleton, const SolveOptions& given,
                                    const Hooks& hooks) {
  SolveOptions options = given;
  SolveSummary found;
  format::skeleton::SkeletonFile file = skeleton_of(recording, skeleton, options, found, hooks);
  options.up = up_of(format::format_to_read(recording, Content::space), skeleton, options);
  std::optional<solve::skeleton::Calibration> calibration;
  if (options.calibrate) {
    calibration = calibrate_skeleton(recording, file.skeleton, skeleton.ends_with(".osim"), options, file.warnings);
    file.skeleton = calibration->skeleton;
  }
  SolvedRecording solved = solve_recording(recording, file, options, hooks);
  const UpAxis taken = format::up_axis(open_markers(recording, options)->info(), options.up);
  if (auto message_text = lies_on_its_side(solved, taken, given.up.has_value(), recording))
    solved.summary.warnings.push_back(std::move(*message_text));
  solved.summary.joints = std::move(found.joints);
  solved.summary.marker_set = std::move(found.marker_set);
  if (calibration) {
    solved.summary.overall_scale = calibration->overall_scale;
    solved.summary.rms_before_m = calibration->rms_before_m;
    solved.summary.undetermined = calibration->undetermined;
    solved.summary.undetermined_markers = calibration->undetermined_markers;
    solved.scales = calibration->scales;
  }
  return solved;
}

SolveSummary solve_skeleton(const std::string& recording, const std::string& skeleton, const std::vector<std::string>& outputs,
                            const SolveOptions& given, const Hooks& hooks) {
  for (const std::string& path : outputs) check_skeleton_output(path);
  const SolvedRecording solved = solve_with_skeleton(recording, skeleton, given, hooks);
  if (solved.summary.stopped) return solved.summary;
  SolveOptions options = given;
  options.up = up_of(format::format_to_read(recording, Content::space), skeleton, options);
  SolveSummary summary = solved.summary;
  MadeBy made_by{.program = "marey solve", .options = hooks.options, .inputs = {format::input_of(recording)}};
  for (const std::string* path : std::initializer_list<const std::string*>{&skeleton, &options.static_trial, &options.motion}) {
    if (!path->empty()) made_by.inputs.push_back(format::input_of(*path));
  }
  for (const std::string& path : outputs) {
    if (auto message_text = write_output(path, recording, solved, options, made_by))
      summary.warnings.push_back(std::move(*message_text));
  }
  if (!options.write_skeleton.empty()) write_skeleton_file(skeleton, solved, options, summary.warnings);
  return summary;
}

}  // namespace marey::pipeline::bodies
