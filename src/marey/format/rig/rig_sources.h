#pragma once

#include <span>
#include <string>

#include "marey/core/rig.h"

namespace marey::format::rig {

/// The camera of that name. Throws Error, with the names that there are, where there is none.
RigCamera& camera_named(Rig& rig, const std::string& name);

/// Other sources than the rig's own, as given on the command line: `cam=VIDEO`; a text file (.txt, .csv) is taken for detections.
/// Throws Error for what is no such pair, a camera that is not in the rig, and one that is given twice.
void set_sources(Rig& rig, std::span<const std::string> pairs);

/// Makes a camera's calibration hold for pictures of `found` px: it is scaled where the shapes agree within a pixel. A camera
/// without a size gets this one. Throws Error where the shapes differ: then the camera has to be calibrated at that size.
void fit_to_size(RigCamera& camera, cv::Size found);

}  // namespace marey::format::rig
