#include "marey/pipeline/markers/skeleton_in_space.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "marey/core/error.h"
#include "marey/pipeline/corridor/stopwatch.h"

namespace marey::pipeline::markers {
namespace {

constexpr double kReacquire_s = 0.25;
constexpr double kPoorFitM = 0.02;  // OpenSim's own advice

/// "A, B, C …"
std::string some_of(std::vector<std::string> labels) {
  const bool more = labels.size() > 4;
  labels.resize(std::min<std::size_t>(4, labels.size()));
  return labels.empty() ? "none" : fmt::format("{}{}", fmt::join(labels, ", "), more ? " …" : "");
}

class SolvedReader final : public RecordingReader {
 public:
  SolvedReader(std::unique_ptr<RecordingReader> recording, std::shared_ptr<const Skeleton> skeleton)
      : recording_(std::move(recording)),
        solved_(std::move(skeleton), recording_->header().rate_hz, live_pose_options()),
        header_(recording_->header()) {
    header_.bodies = solved_.bodies();
    solved_.name(recording_->tracks());
  }

  const RecordingHeader& header() const override { return header_; }
  std::vector<TrackName> tracks() const override { return recording_->tracks(); }
  std::vector<Edit> edits() const override { return recording_->edits(); }
  std::optional<std::int64_t> head() const override { return recording_->head(); }
  std::optional<std::int64_t> instant_count() const override { return recording_->instant_count(); }
  std::optional<Instant> next() override {
    auto instant = recording_->next();
    if (instant) solved_.add_to(*instant);
    return instant;
  }
  std::vector<std::string> warnings() const override {
    std::vector<std::string> all = recording_->warnings();
    for (std::string& warning : solved_.warnings()) all.push_back(std::move(warning));
    return all;
  }

 private:
  std::unique_ptr<RecordingReader> recording_;
  SkeletonInSpace solved_;
  RecordingHeader header_;
};

}  // namespace

SkeletonMarkers::SkeletonMarkers(const Skeleton& skeleton, const std::vector<std::string>& exclude)
    : excluded_(exclude.begin(), exclude.end()), count_(skeleton.markers.size()) {
  for (std::size_t j = 0; j < count_; ++j) {
    if (!excluded_.contains(skeleton.markers[j].label)) by_label_.emplace(skeleton.markers[j].label, j);
  }
}

void SkeletonMarkers::name(std::span<const TrackName> named) {
  const auto give = [&](const TrackName& track, const auto& found) {
    marker_of_[track.id] = found->second;
    recorded_.insert(found->first);
  };
  for (const TrackName& track : named) {
    marker_of_.erase(track.id);
    const auto found = by_label_.find(track.label);
    if (found == by_label_.end()) continue;
    if (!subject_) subject_.emplace();
    give(track, found);
  }
  for (const TrackName& track : named) {
    if (track.label.empty() || marker_of_.contains(track.id)) continue;
    const std::string_view label = track.label, subject = label.substr(0, label.find_last_of(':') + 1);
    const auto found = by_label_.find(label.substr(subject.size()));
    if (found != by_label_.end() && !subject.empty() && subject_.value_or(std::string(subject)) == subject) {
      subject_ = subject;
      give(track, found);
    } else if (!excluded_.contains(label)) {
      unknown_.insert(track.label);
    }
  }
}

void SkeletonMarkers::take(const Instant& instant, solve::skeleton::ObservedMarkers& detected) const {
  detected.assign(count_, std::nullopt);
  for (const Sample& sample : instant.samples) {
    if (sample.provenance == Provenance::predicted || sample.position.isZero()) continue;
    const auto marker = marker_of_.find(sample.track);
    if (marker != marker_of_.end()) detected[marker->second] = sample.position;
  }
}

std::vector<std::string> SkeletonMarkers::not_recorded() const {
  std::vector<std::string> labels;
  for (const auto& [label, marker] : by_label_) {
    if (!recorded_.contains(label)) labels.push_back(label);
  }
  return labels;
}

std::vector<std::string> SkeletonMarkers::unknown() const {
  return {unknown_.begin(), unknown_.end()};
}

std::string SkeletonMarkers::none_known(const std::string& skeleton) const {
  return fmt::format("none of its labels is a marker of the skeleton {}; it has {}, the skeleton {}", skeleton, some_of(unknown()),
                     some_of(not_recorded()));
}

std::vector<BodyPose> segment_poses(const Skeleton& skeleton, std::span<const Body> bodies, std::span<const Matrix<3>> rest,
                                    std::span<const double> coordinates, const std::vector<bool>& observed, double residual_m) {
  const std::vector<Rigid3> world_from = pose_of(skeleton, coordinates);
  std::vector<BodyPose> poses;
  for (std::size_t s = 0; s < bodies.size(); ++s) {
    BodyPose pose{.body = bodies[s].id,
                  .world_from_body = body_pose(world_from[s], rest[s]),
                  .covariance = {},
                  .residual_m = {},
                  .tracked = true};
    const Segment& segment = skeleton.segments[s];
    if (segment.parent && segment.joint.axes.empty()) pose.tracked = poses[static_cast<std::size_t>(*segment.parent)].tracked;
    for (const JointAxis& axis : segment.joint.axes) {
      if (axis.coordinate && !observed[static_cast<std::size_t>(*axis.coordinate)]) pose.tracked = false;
    }
    if (residual_m > 0) pose.residual_m = residual_m;
    poses.push_back(std::move(pose));
  }
  return poses;
}

SkeletonInSpace::SkeletonInSpace(std::shared_ptr<const Skeleton> skeleton, double rate_hz,
                                 const solve::skeleton::PoseOptions& options, const std::vector<std::string>& exclude)
    : skeleton_(std::move(skeleton)),
      rate_hz_(rate_hz),
      markers_(*skeleton_, exclude),
      solver_(*skeleton_, options),
      bodies_(bodies_of(*skeleton_)),
      rest_(rest_of(*skeleton_)) {}

const solve::skeleton::SolvedPose& SkeletonInSpace::solve(const Instant& instant) {
  const corridor::Stopwatch taken;
  markers_.name(instant.named);
  markers_.take(instant, detected_);
  const auto& pose = solver_.step(before_ ? seconds(instant.time - *before_) : 1 / rate_hz_, detected_);
  before_ = instant.time;
  found_ = found_ || pose.detected > 0;
  starts_ += pose.started ? 1 : 0;
  squares_ += pose.rms_m * pose.rms_m * pose.detected;
  count_ += pose.detected;
  times_.add(taken.seconds());
  return pose;
}

void SkeletonInSpace::add_to(Instant& instant) {
  const auto& pose = solve(instant);
  instant.bodies.clear();
  if (found_) instant.bodies = segment_poses(*skeleton_, bodies_, rest_, pose.coordinates, pose.observed, pose.rms_m);
}

std::optional<double> SkeletonInSpace::rms_m() const {
  if (count_ == 0) return std::nullopt;
  return std::sqrt(squares_ / static_cast<double>(count_));
}

std::vector<std::string> SkeletonInSpace::warnings() const {
  std::vector<std::string> stated;
  if (!markers_.any()) {
    stated.push_back("the recording has no pose: " + markers_.none_known(skeleton_->name));
  } else if (const auto missing = markers_.not_recorded(); !missing.empty()) {
    stated.push_back(fmt::format("of the skeleton {} no point bears the names {}", skeleton_->name, fmt::join(missing, ", ")));
  }
  if (const auto rms = rms_m(); rms && *rms > kPoorFitM)
    stated.push_back(fmt::format(
        "markers lie {:.0f} mm RMS from where the skeleton {} has them: is it scaled to this person, and are the labels right?",
        1000 * *rms, skeleton_->name));
  return stated;
}

solve::skeleton::PoseOptions live_pose_options() {
  solve::skeleton::PoseOptions options;
  options.reacquire_s = kReacquire_s;
  return options;
}

format::skeleton::SkeletonFile with_a_marker_a_joint(format::skeleton::SkeletonFile file) {
  Skeleton& skeleton = file.skeleton;
  if (!skeleton.markers.empty()) return file;
  for (std::size_t s = 0; s < skeleton.segments.size(); ++s) {
    const Segment& segment = skeleton.segments[s];
    skeleton.markers.push_back({segment.name, static_cast<int>(s), Vector<3>::Zero(), 1});
    if (segment.end && segment.end->norm() > 0)
      skeleton.markers.push_back({segment.name + ".end", static_cast<int>(s), *segment.end, 1});
  }
  file.warnings.push_back(
      fmt::format("{}: has no markers, so that one is taken to sit on each joint, called as the joint; how bones turn "
                  "about themselves no such marker shows",
                  skeleton.name));
  return file;
}

std::shared_ptr<const Skeleton> skeleton_with_markers(const std::string& path, std::vector<std::string>& warnings) {
  format::skeleton::SkeletonFile file = format::skeleton::read_skeleton(path);
  if (file.skeleton.name.empty()) file.skeleton.name = std::filesystem::path(path).stem().string();
  file = with_a_marker_a_joint(std::move(file));
  for (std::string& warning : file.warnings) warnings.push_back(std::move(warning));
  return std::make_shared<const Skeleton>(std::move(file.skeleton));
}

std::unique_ptr<RecordingReader> with_skeleton(std::unique_ptr<RecordingReader> recording,
                                               std::shared_ptr<const Skeleton> skeleton) {
  if (recording->header().frame.kind != FrameOfReference::Kind::space)
    throw Error("{}: holds no points in space; a skeleton is solved from markers in space", recording->header().name);
  return std::make_unique<SolvedReader>(std::move(recording), std::move(skeleton));
}

}  // namespace marey::pipeline::markers
