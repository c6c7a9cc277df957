// The other half of node: sources: this computer's cameras, handed to the host that solves.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/camera_health.h"
#include "marey/core/hooks.h"
#include "marey/core/rig.h"
#include "marey/detect/markers/marker_detector.h"
#include "marey/source/live/node.h"
#include "marey/source/live_time.h"

namespace marey::pipeline::live {

struct NodeOptions {
  std::string address = "127.0.0.1";  ///< of this machine; "0.0.0.0": all that it has
  int port = source::live::kNodePort;
  std::optional<int> quality;              ///< of JPEGs, 1 to 100: images are sent; else the markers that are found in them
  detect::markers::MarkerOptions markers;  ///< what they are found by
  bool allow_control = false;              ///< hosts may set exposure, gain and threshold
  double patience_s = 3;                   ///< that cameras are waited for at the beginning
  std::optional<double> for_s;             ///< it ends after this long, not only when it is stopped
  std::function<void(const Rig&)> begun;   ///< when it listens, with what hosts are reported of its cameras
};

struct NodeSummary {
  struct Camera {
    CameraHealth health;
    std::int64_t sent = 0;  ///< frames
  };
  std::vector<Camera> cameras;
  double seconds = 0;
  std::int64_t bytes = 0;  ///< of all messages that were made, the one who got them
};

/// Opens the rig's cameras and distributes what they give until all have ended, or it is stopped. Cameras that are not there are
/// tried again without end. Throws Error if no source can be meant, or the ports cannot be had.
NodeSummary serve_cameras(const Rig& rig, const NodeOptions& options, const Hooks& hooks);

}  // namespace marey::pipeline::live
