#pragma once

#include <string>
#include <vector>

#include "marey/calibrate/wand/wand_marks.h"
#include "marey/core/hooks.h"
#include "marey/core/rig.h"
#include "marey/detect/markers/marker_detector.h"

namespace marey::pipeline::calibrate {

/// What all cameras of a rig saw, by camera and frame, each by its own clock.
struct CameraBlobs {
  std::vector<std::vector<marey::calibrate::wand::BlobFrame>> detected;
  bool timed = true;  ///< false: the rate is not known, frame numbers stand for seconds and cameras run synchronised
  std::vector<std::string> warnings;
};

/// Reads what another program found (see ObservationReader). Frame f of a camera was at f / rate, its `rate_hz` or `rate_hz` of any
/// other.
CameraBlobs read_blobs(const std::string& observations, const Rig& rig);

/// Finds markers in the cameras' sources, cameras in parallel; live cameras are observed for three seconds (live_blobs.h). Sets
/// the sizes that the rig lacks. Throws Error if a source cannot be read, or its image does not have the camera's size;
/// Stopped.
CameraBlobs find_blobs(Rig& rig, const detect::markers::MarkerOptions& options, const Hooks& hooks);

/// The first of a file of observations, the second if no file is given.
CameraBlobs blobs_of(Rig& rig, const std::string& observations, const detect::markers::MarkerOptions& options, const Hooks& hooks);

}  // namespace marey::pipeline::calibrate
