#pragma once

#include <memory>

#include "marey/detect/detectors.h"
#include "marey/pipeline/corridor/run.h"

namespace marey::pipeline::corridor {

/// What there is to be seen before a rig is calibrated: each camera's detections, as `Instant::seen`, and nothing that is followed.
/// Feeds that do not detect themselves are searched here, side by side. Instants are in the rig's space, without samples.
std::unique_ptr<Stage> preview(const std::vector<Feed>& feeds, const Rig& rig, double rate_hz,
                               const detect::DetectorOptions& detector);

}  // namespace marey::pipeline::corridor
