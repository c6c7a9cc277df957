#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/marker_set.h"
#include "marey/core/rig.h"
#include "marey/detect/markers/marker_detector.h"
#include "marey/pipeline/run.h"
#include "marey/pipeline/stage_times.h"
#include "marey/reconstruct/correspond.h"
#include "marey/track/roster_tracker.h"

namespace marey::pipeline {

/// What fits markers in space: m.
track::RosterTrackerOptions space_tracker_options();

struct ReconstructOptions {
  detect::markers::MarkerOptions markers;
  reconstruct::CorrespondOptions correspond = {};
  std::optional<double> noise_px;  ///< of blobs and calibration together; nothing: learned from how well rays meet
  track::RosterTrackerOptions tracker = space_tracker_options();
  MarkerSet set;                  ///< labels, with places where the markers keep their distances at the beginning; may be empty
  std::optional<double> rate_hz;  ///< of sources and observations that do not tell theirs
  double fill_s = 0.5;            ///< longest gap that is filled
  double predict_s = 0;           ///< of a longer gap, this much is told as it was expected; ≤ fill_s
};

/// How long one step took, s.
struct StageReport {
  std::string name;
  std::int64_t count = 0;
  double median = 0, p99 = 0;
};

struct ReconstructSummary {
  struct CameraCount {
    std::string name;
    std::int64_t frames = 0;  ///< it gave
    std::int64_t missed = 0;  ///< instants for which it had none
  };
  std::int64_t frames = 0;  ///< instants
  double seconds = 0;
  double rate_hz = 0;
  std::int64_t markers = 0;  ///< distinct tracks in the take
  std::int64_t labelled = 0;
  std::int64_t observations = 0, unexplained = 0;
  std::int64_t measured = 0, filled = 0, predicted = 0;  ///< points
  std::optional<double> residual_px;                     ///< RMS over all measured points
  double noise_px = 0;                                   ///< of blobs and calibration, as given or learned
  std::vector<CameraCount> cameras;
  std::vector<StageReport> stages;
  bool stopped = false;
  std::vector<std::string> warnings;
};

/// Places and follows the markers that a calibrated rig sees, and writes them to `out`: NAME.marey is a take, written as it grows;
/// other endings that format/motion.h knows (.c3d, .trc, .csv) are written at the end, out of a take that is then removed.
/// `observations` names what another program saw, in place of the rig's sources; empty for none. Cameras without a calibration are
/// left out, with a warning. Memory does not grow with the recording. Throws Error where an input cannot be read or the take cannot
/// be written.
ReconstructSummary reconstruct(Rig rig, const std::string& observations, const std::string& out,
                               const ReconstructOptions& options = {}, const RunHooks& hooks = {});

}  // namespace marey::pipeline
