#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "marey/calibrate/wand/wand.h"
#include "marey/core/camera_health.h"
#include "marey/core/hooks.h"
#include "marey/core/instant.h"
#include "marey/detect/markers/marker_detector.h"
#include "marey/pipeline/live/camera_settings.h"

namespace marey::pipeline::calibrate {

/// How far a wand that is waved before live cameras has been seen.
struct WandObserved {
  struct Camera {
    CameraHealth health;
    double coverage = 0;     ///< share of its image in which the wand was
    std::int64_t views = 0;  ///< frames in which it was
    bool covered = false;    ///< that is enough
    std::vector<int> parts;  ///< in which it was, of 10 × 8 row by row
  };
  /// Two cameras that saw it at the same time.
  struct Shared {
    std::size_t a = 0, b = 0;  ///< a < b, by `cameras`
    std::int64_t views = 0;
    bool enough = false;  ///< to find their relative poses
  };
  double seconds = 0;
  std::vector<Camera> cameras;
  std::vector<Shared> shared;  ///< of all pairs
  /// What each camera sees now: images where it gives some, blobs, those that are the wand's as tracks 1, 2, 3. No time of it is
  /// exact: cameras' newest frames.
  Instant now;
  bool enough = false;  ///< every camera is covered, and all are chained by views that two of them share
};

/// Whether every camera's lens is given: else more of the wand is wanted.
bool knows_lenses(const Rig& rig);

struct CalibrateWandOptions {
  std::string observations;  ///< what another program saw of the wand; empty: it is searched for in the cameras' sources
  detect::markers::MarkerOptions markers;
  marey::calibrate::MarkerLine wand;
  marey::calibrate::wand::WandOptions how;  ///< offsets are searched for unless `synced`, or no person says the cameras' rate
  bool synced = false;                      ///< the cameras' clocks are right
  live::CameraSettings* camera_settings =
      nullptr;          ///< live cameras: by which they are set while the wand is waved, and the rig that is found too
  double wave_s = 600;  ///< live cameras: the wand is waved until it was seen enough, at most this long
  /// Ten times a second while it is waved; false: the observations suffice. May be empty.
  std::function<bool(const WandObserved& detected)> waving = {};
  /// It has been waved: the rest is computed. May be empty.
  std::function<void()> waved = {};
};

struct WandCalibration {
  marey::calibrate::wand::WandResult found;
  std::vector<std::string> warnings;  ///< of the cameras' sources, one sentence each
};

/// Where the rig's cameras stand, by a wand or a light waved before them: in videos, or before live cameras now. Throws Error if
/// a source cannot be read, and as calibrate::wand::calibrate_wand does; Stopped.
WandCalibration calibrate_wand(const Rig& rig, const CalibrateWandOptions& options, const Hooks& hooks = {});

}  // namespace marey::pipeline::calibrate
