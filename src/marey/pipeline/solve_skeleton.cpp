#include "marey/pipeline/solve_skeleton.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "marey/core/error.h"
#include "marey/core/track_names.h"
#include "marey/core/whole_file.h"
#include "marey/format/recording_file.h"
#include "marey/format/register.h"
#include "marey/format/skeleton/gltf.h"
#include "marey/format/skeleton/motion_table.h"
#include "marey/pipeline/gait_markers.h"
#include "marey/solve/skeleton/calibrate.h"
#include "marey/solve/skeleton/smooth.h"

namespace marey::pipeline {
namespace {

using format::Content;
using format::UpAxis;
constexpr std::size_t kMostCalibrationFrames = 4096;

bool ends_with_any(const std::string& path, std::initializer_list<std::string_view> endings) {
  return std::any_of(endings.begin(), endings.end(), [&](std::string_view ending) { return path.ends_with(ending); });
}

/// "Jane:LKNE" is LKNE of a subject Jane.
std::string_view without_subject(std::string_view label) {
  return label.substr(label.find_last_of(':') + 1);
}

/// "A, B, C …"
std::string first_of(std::vector<std::string> labels) {
  const bool more = labels.size() > 4;
  labels.resize(std::min<std::size_t>(4, labels.size()));
  return labels.empty() ? "none" : fmt::format("{}{}", fmt::join(labels, ", "), more ? " …" : "");
}

/// Which of the recording's tracks are the skeleton's markers.
class MarkersByLabel {
 public:
  MarkersByLabel(const Skeleton& skeleton, const std::vector<std::string>& leave_out) {
    const std::set<std::string, std::less<>> without(leave_out.begin(), leave_out.end());
    for (std::size_t j = 0; j < skeleton.markers.size(); ++j) {
      if (!without.contains(skeleton.markers[j].label)) by_label_.emplace(skeleton.markers[j].label, j);
    }
    for (const std::string& label : leave_out) left_out_.insert(label);
  }

  void add(std::span<const TrackName> named) {
    for (const TrackName& track : named) {
      auto found = by_label_.find(std::string_view(track.label));
      if (found == by_label_.end()) found = by_label_.find(without_subject(track.label));
      if (found != by_label_.end()) {
        marker_of_[track.id] = found->second;
        recorded_.insert(found->first);
      } else if (!track.label.empty() && !left_out_.contains(track.label)) {
        unknown_.insert(track.label);
      }
    }
  }

  std::optional<std::size_t> marker(TrackId track) const {
    const auto found = marker_of_.find(track);
    return found == marker_of_.end() ? std::nullopt : std::optional(found->second);
  }
  std::vector<std::string> not_recorded() const {
    std::vector<std::string> labels;
    for (const auto& [label, j] : by_label_) {
      if (!recorded_.contains(label)) labels.push_back(label);
    }
    return labels;
  }
  std::vector<std::string> unknown() const { return {unknown_.begin(), unknown_.end()}; }
  bool any() const { return !recorded_.empty(); }

 private:
  std::map<std::string, std::size_t, std::less<>> by_label_;
  std::map<TrackId, std::size_t> marker_of_;
  std::set<std::string, std::less<>> recorded_, unknown_, left_out_;
};

/// Sums up poses as they come.
class SolveCounts {
 public:
  explicit SolveCounts(const Skeleton& skeleton)
      : skeleton_(skeleton),
        markers_(skeleton.markers.size()),
        deviations_(skeleton.coordinates.size()),
        observed_(skeleton.coordinates.size()) {}

  void add(const solve::skeleton::SolvedPose& pose) {
    starts_ += pose.started ? 1 : 0;
    if (pose.seen == 0) {
      ++empty_;
      return;
    }
    for (std::size_t j = 0; j < markers_.size(); ++j) {
      if (!pose.residuals[j]) continue;
      ++markers_[j].seen;
      markers_[j].rms_m += *pose.residuals[j] * *pose.residuals[j];
      markers_[j].worst_m = std::max(markers_[j].worst_m, *pose.residuals[j]);
    }
    for (std::size_t c = 0; c < deviations_.size(); ++c) {
      deviations_[c].push_back(static_cast<float>(pose.deviations[c]));
      observed_[c] += pose.observed[c] ? 1 : 0;
    }
  }

  void write(const SkeletonMotion& motion, SolveSummary& summary) {
    summary.starts = starts_;
    summary.empty = empty_;
    double sum = 0;
    std::int64_t count = 0;
    for (std::size_t j = 0; j < markers_.size(); ++j) {
      SolveSummary::Marker& marker = markers_[j];
      if (marker.seen == 0) continue;
      marker.label = skeleton_.markers[j].label;
      sum += marker.rms_m;
      count += marker.seen;
      marker.rms_m = std::sqrt(marker.rms_m / static_cast<double>(marker.seen));
      summary.worst_m = std::max(summary.worst_m, marker.worst_m);
      summary.markers.push_back(marker);
    }
    summary.rms_m = count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0;
    for (std::size_t c = 0; c < skeleton_.coordinates.size(); ++c) {
      if (skeleton_.coordinates[c].free()) summary.coordinates.push_back(coordinate(c, motion));
    }
  }

 private:
  SolveSummary::Coordinate coordinate(std::size_t c, const SkeletonMotion& motion) {
    SolveSummary::Coordinate said{.name = skeleton_.coordinates[c].name, .turns = skeleton_.coordinates[c].turns};
    for (std::size_t r = 0; r < motion.rows.size(); ++r) {
      said.lowest = r == 0 ? motion.rows[r][c] : std::min(said.lowest, motion.rows[r][c]);
      said.highest = r == 0 ? motion.rows[r][c] : std::max(said.highest, motion.rows[r][c]);
    }
    std::vector<float>& all = deviations_[c];
    if (all.empty()) return said;
    const auto middle = all.begin() + std::ssize(all) / 2;
    std::nth_element(all.begin(), middle, all.end());
    said.deviation = *middle;
    said.observed = static_cast<double>(observed_[c]) / static_cast<double>(all.size());
    return said;
  }

  const Skeleton& skeleton_;
  std::vector<SolveSummary::Marker> markers_;
  std::vector<std::vector<float>> deviations_;
  std::vector<std::int64_t> observed_;
  std::int64_t starts_ = 0, empty_ = 0;
};

UpAxis up_of(const format::Format& format, const std::string& skeleton, const SolveOptions& options) {
  if (options.up) return *options.up;
  return format.name == "trc" && skeleton.ends_with(".osim") ? UpAxis::y : UpAxis::z;
}

std::unique_ptr<format::FileReader> open_markers(const std::string& path, const SolveOptions& options) {
  const format::Format& format = format::format_to_read(path, Content::space);
  format::ReadOptions how;
  how.up = options.up.value_or(UpAxis::z);
  auto reader = format::open_recording(path, format, how);
  if (reader->header().frame.kind != FrameOfReference::Kind::space)
    throw Error("{}: holds no points in space; a skeleton is solved from markers in space", path);
  return reader;
}

/// Bodies of one instant.
std::vector<BodyPose> poses_of(const SolvedRecording& solved, const std::vector<Body>& bodies, const std::vector<Matrix<3>>& rest,
                               std::size_t row) {
  const std::vector<Rigid3> world_from = pose_of(solved.skeleton, solved.motion.rows[row]);
  std::vector<BodyPose> poses;
  for (std::size_t s = 0; s < bodies.size(); ++s) {
    BodyPose pose{.body = bodies[s].id,
                  .world_from_body = body_pose(world_from[s], rest[s]),
                  .covariance = {},
                  .residual_m = {},
                  .tracked = true};
    for (const JointAxis& axis : solved.skeleton.segments[s].joint.axes) {
      if (axis.coordinate && !solved.observed[row][static_cast<std::size_t>(*axis.coordinate)]) pose.tracked = false;
    }
    if (solved.residual_m[row] > 0) pose.residual_m = solved.residual_m[row];
    poses.push_back(std::move(pose));
  }
  return poses;
}

/// The recording again, with its bodies, into a sink.
void replay_with_bodies(const std::string& recording, const SolvedRecording& solved, const SolveOptions& options, Sink& sink) {
  const auto reader = open_markers(recording, options);
  RecordingHeader header = reader->header();
  header.bodies = bodies_of(solved.skeleton);
  const std::vector<Matrix<3>> rest = rest_of(solved.skeleton);
  sink.begin(header);
  std::size_t row = 0;
  while (auto instant = reader->next()) {
    if (row >= solved.motion.rows.size()) break;
    if (row == 0) instant->named = reader->tracks();
    instant->bodies = poses_of(solved, header.bodies, rest, row++);
    sink.write(*instant);
  }
  sink.finish();
}

void write_output(const std::string& path, const std::string& recording, const SolvedRecording& solved,
                  const SolveOptions& options) {
  if (ends_with_any(path, {".mot", ".sto"})) return format::skeleton::write_motion_table(path, solved.skeleton, solved.motion);
  if (path.ends_with(".glb")) return replay_with_bodies(recording, solved, options, *format::skeleton::create_glb(path));
  if (path.ends_with(".bvh"))
    return replay_with_bodies(recording, solved, options, *format::skeleton::create_bvh(path, options.bvh));
  const format::Format& format = format::format_to_write(path, "", Content::space);
  format::WritePlan plan = format::plan_of(*open_markers(recording, options), recording);
  plan.info.header.bodies = bodies_of(solved.skeleton);
  replay_with_bodies(recording, solved, options, *format::create_recording(path, format, plan));
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
  SolvedRecording solved{.skeleton = file.skeleton, .motion = {}, .observed = {}, .residual_m = {}, .summary = {}};
  SolveSummary& summary = solved.summary;
  summary.warnings = file.warnings;
  summary.skeleton = file.skeleton.name;
  const auto reader = open_markers(recording, options);
  MarkersByLabel labels(solved.skeleton, options.leave_out);
  labels.add(reader->tracks());
  solve::skeleton::PoseSolver solver(solved.skeleton, options.pose);
  SolveCounts counts(solved.skeleton);
  std::vector<std::optional<Vector<3>>> seen(solved.skeleton.markers.size());
  std::vector<solve::skeleton::SeenMarkers> all;
  solved.motion.rate_hz = summary.rate_hz = reader->header().rate_hz;
  std::optional<Timestamp> before;
  while (const auto instant = reader->next()) {
    labels.add(instant->named);
    std::fill(seen.begin(), seen.end(), std::nullopt);
    for (const Sample& sample : instant->samples) {
      // Some systems write 0, 0, 0 where a marker is missing.
      if (sample.provenance == Provenance::predicted || sample.position.isZero()) continue;
      if (const auto j = labels.marker(sample.track)) seen[*j] = sample.position;
    }
    const auto& pose = solver.step(before ? seconds(instant->time - *before) : 1 / solved.motion.rate_hz, seen);
    before = instant->time;
    counts.add(pose);
    solved.motion.times.push_back(instant->time);
    solved.motion.rows.push_back(pose.coordinates);
    solved.observed.push_back(pose.observed);
    solved.residual_m.push_back(pose.rms_m);
    if (options.smooth) all.push_back(seen);
    if (hooks.report({.step = "solving", .done = ++summary.frames, .total = reader->instant_count()}) == Continue::no) {
      summary.stopped = true;
      break;
    }
  }
  if (!labels.any())
    throw Error("{}: none of its labels is a marker of the skeleton {}; it has {}, the skeleton {}", recording,
                solved.skeleton.name, first_of(labels.unknown()), first_of(labels.not_recorded()));
  if (options.smooth) solved.motion.rows = solve::skeleton::smooth(solved.skeleton, solved.motion.rows, all, solved.motion.rate_hz);
  for (const std::string& warning : reader->warnings()) summary.warnings.push_back(warning);
  summary.not_recorded = labels.not_recorded();
  summary.not_known = labels.unknown();
  if (summary.frames > 1) summary.seconds = seconds(solved.motion.times.back() - solved.motion.times.front());
  counts.write(solved.motion, summary);
  return solved;
}

namespace {

/// The markers of all frames, for a calibration.
std::vector<solve::skeleton::SeenMarkers> all_seen(const std::string& recording, const Skeleton& skeleton,
                                                   const SolveOptions& options) {
  const auto reader = open_markers(recording, options);
  MarkersByLabel labels(skeleton, options.leave_out);
  labels.add(reader->tracks());
  std::vector<solve::skeleton::SeenMarkers> frames;
  std::size_t step = 1, count = 0;
  while (const auto instant = reader->next()) {
    labels.add(instant->named);
    if (count++ % step != 0) continue;
    solve::skeleton::SeenMarkers seen(skeleton.markers.size());
    for (const Sample& sample : instant->samples) {
      if (sample.provenance == Provenance::predicted || sample.position.isZero()) continue;
      if (const auto j = labels.marker(sample.track)) seen[*j] = sample.position;
    }
    frames.push_back(std::move(seen));
    if (frames.size() < kMostCalibrationFrames) continue;
    for (std::size_t i = 0; 2 * i < frames.size(); ++i) frames[i] = std::move(frames[2 * i]);
    frames.resize((frames.size() + 1) / 2);
    step *= 2;
  }
  return frames;
}

format::skeleton::SkeletonFile skeleton_of(const std::string& skeleton, const SolveOptions& options, const Hooks& hooks) {
  if (!skeleton.empty()) {
    format::skeleton::SkeletonFile file = format::skeleton::read_skeleton(skeleton, options.read_skeleton);
    if (file.skeleton.name.empty()) file.skeleton.name = skeleton;
    return file;
  }
  if (options.static_trial.empty())
    throw Error("a skeleton is wanted: --skeleton FILE, or --static of the person standing with Plug-in Gait's markers");
  format::skeleton::SkeletonFile file;
  file.skeleton = human_from_static(options.static_trial, options.up, hooks);
  return file;
}

void write_skeleton_file(const std::string& path, const Skeleton& skeleton) {
  WholeFile file(path);
  file.write(format::skeleton::to_toml(skeleton));
  file.finish();
}

}  // namespace

SolvedRecording solve_with_skeleton(const std::string& recording, const std::string& skeleton, const SolveOptions& given,
                                    const Hooks& hooks) {
  SolveOptions options = given;
  format::skeleton::SkeletonFile file = skeleton_of(skeleton, options, hooks);
  options.up = up_of(format::format_to_read(recording, Content::space), skeleton, options);
  std::optional<solve::skeleton::Calibration> calibration;
  if (options.calibrate) {
    calibration = solve::skeleton::calibrate(file.skeleton, all_seen(recording, file.skeleton, options));
    file.skeleton = calibration->skeleton;
  }
  SolvedRecording solved = solve_recording(recording, file, options, hooks);
  if (calibration) {
    solved.summary.overall_scale = calibration->overall_scale;
    solved.summary.rms_before_m = calibration->rms_before_m;
    solved.summary.undetermined = calibration->undetermined;
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
  for (const std::string& path : outputs) write_output(path, recording, solved, options);
  if (!options.write_skeleton.empty()) write_skeleton_file(options.write_skeleton, solved.skeleton);
  return solved.summary;
}

}  // namespace marey::pipeline
