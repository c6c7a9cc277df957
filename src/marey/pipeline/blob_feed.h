#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/observation.h"
#include "marey/core/rig.h"
#include "marey/core/time.h"
#include "marey/detect/markers/marker_detector.h"

namespace marey::pipeline {

/// What one camera saw in one of its frames.
struct SeenBlobs {
  Timestamp time{};                   ///< by the rig's clock
  std::vector<Observation<2>> blobs;  ///< px; `camera` is set
  double decode_s = 0, detect_s = 0;  ///< what it took
};

/// One camera's blobs, frame by frame.
class BlobFeed {
 public:
  virtual ~BlobFeed() = default;
  virtual std::optional<SeenBlobs> next() = 0;
  virtual double rate_hz() const = 0;
  virtual std::vector<std::string> warnings() const { return {}; }
};

/// Opens every camera's source and looks for markers in it. Cameras without a source give nothing. Calibrations that are for
/// another resolution of the same shape are scaled in `rig`. Throws Error where a source cannot be opened or its shape does not
/// fit.
std::vector<std::unique_ptr<BlobFeed>> open_videos(Rig& rig, const detect::markers::MarkerOptions& markers,
                                                   std::optional<double> rate_hz);

/// What another program saw, from a file or folder that format/observations.h reads. `rate_hz` counts where the rig does not say.
std::vector<std::unique_ptr<BlobFeed>> open_observations(const std::string& path, const Rig& rig, std::optional<double> rate_hz);

}  // namespace marey::pipeline
