#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "marey/analyse/teams.h"
#include "marey/core/geometry.h"
#include "marey/core/rig.h"
#include "marey/geometry/pitch.h"
#include "marey/pipeline/ground_cameras.h"
#include "marey/pipeline/people_eyes.h"
#include "marey/pipeline/run_hooks.h"
#include "marey/track/ground/ground_recorder.h"
#include "marey/track/ground/ground_tracker.h"

namespace marey::pipeline {

struct TrackGroundOptions {
  DetectionStageOptions eyes;
  track::ground::GroundTrackerOptions tracker;
  track::ground::GroundJoinOptions join;
  analyse::TeamOptions teams;                ///< `pitch` is taken from below
  std::optional<double> rate_hz;             ///< of cameras of which the rig does not say it
  std::optional<geometry::PitchSize> pitch;  ///< only people on it count; nothing: everybody does
  double margin = 2;                         ///< m round the pitch where people still count
  /// Every instant is written as it comes: nothing is read ahead and nothing improved by what came later.
  bool live = false;
};

/// Where the results go; what is empty is not made.
struct GroundOutput {
  std::string tracks;      ///< CSV as format/ground_file.h has it, unless `boxes_of` names a camera
  std::string boxes_of;    ///< a camera: `tracks` then is MOT text, the boxes in that view by that camera's own frames
  std::string overlays;    ///< a folder: <camera>.mp4, a film of each camera that has pictures
  std::string pitch_view;  ///< a film of the ground from above
};

struct GroundSummary {
  struct Camera {
    std::string name;
    GroundCameras::Counts counts;
  };
  std::int64_t frames = 0;      ///< instants: frames of the first camera
  double seconds = 0;           ///< from the first instant to the last
  std::int64_t people = 0;      ///< distinct numbers
  std::int64_t rows = 0;        ///< people times the instants they are in
  std::int64_t predicted = 0;   ///< rows in which nobody saw the person
  std::int64_t off_pitch = 0;   ///< people left out: never on the pitch or its margin
  std::vector<Camera> cameras;  ///< in the rig's order
  std::vector<analyse::Teams::Team> teams;
  std::vector<std::string> notes;  ///< what was found out beside, one sentence each: when cameras were started
  double tracking_s = 0;           ///< wall time of the first pass: decoding, detecting, tracking
  double joining_s = 0;            ///< of the second

  bool stopped = false;               ///< before the end, because a hook said so
  std::vector<std::string> warnings;  ///< one sentence each
};

/// Follows everybody on the ground that the rig's cameras look at, under one identity across all of them, and writes where they
/// were in the coordinates of the rig's user (`ground_from_world`). Frames and times are the first camera's. Memory grows with the
/// rows; it does not where `live` and no film is wanted. The same input gives the same output, bit for bit. Throws Error where a
/// camera cannot be read or is not calibrated, or an output not written; nothing half-written stays behind.
GroundSummary track_ground(const Rig& rig, const GroundOutput& output, const TrackGroundOptions& options = {},
                           const RunHooks& hooks = {});

}  // namespace marey::pipeline
