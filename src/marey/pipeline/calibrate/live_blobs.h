// What live cameras see of markers while something is shown to them: a wand that is waved, an L-frame on the floor.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "marey/core/hooks.h"
#include "marey/pipeline/calibrate/camera_blobs.h"
#include "marey/pipeline/corridor/feed.h"
#include "marey/pipeline/live/camera_settings.h"

namespace marey::pipeline::calibrate {

/// Whether any of its cameras is live, as `marey live` takes them.
bool has_live_cameras(const Rig& rig);

/// While cameras are observed.
struct BlobPreview {
  const CameraBlobs& blobs;  ///< what came so far
  std::span<const corridor::Feed> feeds;
  std::span<const CameraFrame> newest;  ///< by camera, the last that came; without image and detections where none did
  const source::LivePolicy& policy;
  double seconds = 0;  ///< since the first frame
};

struct LiveBlobsOptions {
  detect::markers::MarkerOptions markers;
  live::CameraSettings* camera_settings = nullptr;  ///< by which cameras are set in the meantime; else they stay as the rig says
  double patience_s = 5;                            ///< that cameras are waited for at the beginning
  double for_s = 3;                                 ///< they are observed for this long, from when the first frame came
  std::function<bool(const BlobPreview&)> will_do = {};  ///< called ten times a second: whether that is enough; may be empty
};

/// Sets sizes and rates that the rig lacks. Times are by the cameras' own clocks, as far as they differ by the rig's offsets.
/// Throws Error if no camera gives a frame; Stopped.
CameraBlobs observe_live_blobs(Rig& rig, const LiveBlobsOptions& options, const Hooks& hooks);

}  // namespace marey::pipeline::calibrate
