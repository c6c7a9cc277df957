// How a camera of a rig is turned over time: a file beside the rig file, a row a frame. It is no part of `Rig`, which is what stays
// of a setup and is copied freely.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core/types.hpp>

#include "marey/core/rig.h"
#include "marey/core/turning_camera.h"

namespace marey::format::rig {

/// Reads `time,pan,tilt,focal,pan_sd,tilt_sd,focal_sd,pan_tilt,pan_focal,tilt_focal`: s by the camera's clock, degrees, px of a
/// picture of `size`, standard deviations and correlations; a row with a time alone is a frame where the camera is lost. Nothing of
/// the tripod is in it. Throws Error with the line for what is none of this, and for times that do not ascend.
std::vector<TurningCamera::Turn> parse_turns(std::string_view text, const std::string& name, cv::Size size);

std::string turns_text(const TurningCamera& camera, cv::Size size);

/// How each camera of a rig file is turned, in the file's order; nothing for one that stands (`turns`, `tripod`, `lean`,
/// `nodal_offset` and `bend` of a camera, docs/rig.md). Throws Error with every problem of the file.
std::vector<std::shared_ptr<const TurningCamera>> read_turning(const std::string& rig_path);

/// Writes a rig file as `write_rig` does, the turns of each of its cameras that turns in a file beside it, RIG_CAMERA_turns.csv.
/// `turning` as `read_turning` gives it; such a camera has its size. Throws Error where that cannot be.
void write_turning_rig(const Rig& rig, const std::vector<std::shared_ptr<const TurningCamera>>& turning, const std::string& path);

}  // namespace marey::format::rig
