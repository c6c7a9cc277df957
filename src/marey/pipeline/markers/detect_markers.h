// Markers in the images of one camera, image by image, without following them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "marey/core/hooks.h"
#include "marey/core/rig.h"
#include "marey/detect/markers/marker_detector.h"

namespace marey::pipeline::markers {

/// Where the results go; what is empty is not made.
struct BlobOutput {
  std::string blobs;    ///< CSV, or JSON lines where its ending is .jsonl
  std::string overlay;  ///< the blobs drawn into the images: a video (.mp4), or of the first image one (.png, .jpg)
};

/// The result.
struct BlobSummary {
  std::int64_t frames = 0;
  std::int64_t blobs = 0;
  std::int64_t maximum = 0;  ///< in one image
  double seconds = 0;        ///< from the first image to the last
  double detect_s = 0;       ///< of computing, all images together
  double threshold = 0;      ///< the contrast that a pixel must have, grey levels: the middle of the last image's
  double noise = 0;          ///< of a pixel, grey levels
  detect::markers::MarkerCounts counts;
  std::vector<std::string> warnings;
  bool stopped = false;
};

/// Finds the markers in what `camera.source` names: a video, a folder, a pattern or one image. Throws Error if that cannot be
/// read, or an output not be written; nothing half-written stays behind.
BlobSummary detect_markers(const RigCamera& camera, const BlobOutput& output, const detect::markers::MarkerOptions& options = {},
                           const Hooks& hooks = {});

}  // namespace marey::pipeline::markers
