// A skeleton's pose out of labelled points in space: a step that any stage takes, live too, and any recording that is read.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "marey/core/instant.h"
#include "marey/core/recording_reader.h"
#include "marey/core/skeleton.h"
#include "marey/core/stage_times.h"
#include "marey/format/skeleton/skeleton_file.h"
#include "marey/solve/skeleton/calibrate.h"
#include "marey/solve/skeleton/pose_solver.h"

namespace marey::pipeline::markers {

/// Which tracks of a recording are a skeleton's markers: by their labels. "Jane:LKNE" is LKNE of a subject Jane.
class SkeletonMarkers {
 public:
  /// The skeleton must outlive it. Markers of the labels in `exclude` are not used.
  explicit SkeletonMarkers(const Skeleton& skeleton, const std::vector<std::string>& exclude = {});

  /// A label counts as the skeleton has it, or with a subject's name before it ("Jane:LASI"): then that of the first subject, and
  /// another one's labels are unknown.
  void name(std::span<const TrackName> named);
  /// Where each of the skeleton's markers is at this instant, as far as it was measured, filled or solved: what is predicted says
  /// nothing new, and some systems write 0, 0, 0 where a marker is missing.
  void take(const Instant& instant, solve::skeleton::ObservedMarkers& detected) const;

  std::vector<std::string> not_recorded() const;  ///< the skeleton's labels that no track has
  std::vector<std::string> unknown() const;       ///< labels that the skeleton has not
  bool any() const { return !recorded_.empty(); }
  /// "none of its labels is a marker of the skeleton NAME; it has …, the skeleton …"
  std::string none_known(const std::string& skeleton) const;

 private:
  std::map<std::string, std::size_t, std::less<>> by_label_;
  std::map<TrackId, std::size_t> marker_of_;
  std::set<std::string, std::less<>> recorded_, unknown_, excluded_;
  std::optional<std::string> subject_;  // "Jane:"; empty if labels have none
  std::size_t count_;
};

/// The segments at one instant, as poses of those `bodies`: tracked where this instant's markers show all of a segment's joint.
std::vector<BodyPose> segment_poses(const Skeleton& skeleton, std::span<const Body> bodies, std::span<const Matrix<3>> rest,
                                    std::span<const double> coordinates, const std::vector<bool>& observed, double residual_m);

/// Puts into each instant where the skeleton's segments are, frame by frame as `marey solve` finds them. Before the first marker is
/// seen none are reported; while a segment is hidden it is reported where it is expected, as not tracked.
class SkeletonInSpace {
 public:
  /// Throws Error if the skeleton has no markers or nothing that moves.
  SkeletonInSpace(std::shared_ptr<const Skeleton> skeleton, double rate_hz, const solve::skeleton::PoseOptions& options = {},
                  const std::vector<std::string>& exclude = {});

  const std::vector<Body>& bodies() const { return bodies_; }
  void name(std::span<const TrackName> named) { markers_.name(named); }
  /// The pose at this instant, which is later than the last one; its names count. Valid until the next call.
  const solve::skeleton::SolvedPose& solve(const Instant& instant);
  /// `instant.bodies` becomes the segments' poses.
  void add_to(Instant& instant);

  const solve::skeleton::ObservedMarkers& detected() const { return detected_; }  ///< of the last instant
  const SkeletonMarkers& markers() const { return markers_; }
  const StageTimes& times() const { return times_; }
  /// RMS distance of all markers so far from where the skeleton has them, m; nothing before one was seen.
  std::optional<double> rms_m() const;
  std::int64_t starts() const { return starts_; }  ///< poses found without the one before
  /// What its user should know at the end, one sentence each.
  std::vector<std::string> warnings() const;

 private:
  std::shared_ptr<const Skeleton> skeleton_;
  double rate_hz_;
  SkeletonMarkers markers_;
  solve::skeleton::PoseSolver solver_;
  std::vector<Body> bodies_;
  std::vector<Matrix<3>> rest_;
  solve::skeleton::ObservedMarkers detected_;
  std::optional<Timestamp> before_;
  bool found_ = false;
  StageTimes times_;
  double squares_ = 0;
  std::int64_t count_ = 0, starts_ = 0;
};

/// Of a live run: a body that does not fit its skeleton is sought again at most this often, for a search takes longer than a
/// frame.
solve::skeleton::PoseOptions live_pose_options();

/// A skeleton file without markers (BVH, ASF) with one on each joint, called as the joint, and `NAME.end` where a segment ends, as
/// OpenMoCap's semantics have it. Its warnings say so.
format::skeleton::SkeletonFile with_a_marker_a_joint(format::skeleton::SkeletonFile file);

/// From a file, for those who solve as they go. Its warnings are added to `warnings`. Throws Error if the file is not a skeleton,
/// or one that has neither markers nor joints.
std::shared_ptr<const Skeleton> skeleton_with_markers(const std::string& path, std::vector<std::string>& warnings);

/// The recording with the skeleton's segments in the place of its bodies. Throws Error if it has no points in space.
std::unique_ptr<RecordingReader> with_skeleton(std::unique_ptr<RecordingReader> recording,
                                               std::shared_ptr<const Skeleton> skeleton);

}  // namespace marey::pipeline::markers
