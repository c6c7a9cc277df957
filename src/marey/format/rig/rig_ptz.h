// How a camera of a rig is turned over time: a file beside the rig file, a row a frame. It is not a part of `Rig`, which is what
// stays of a setup and is copied freely.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core/types.hpp>

#include "marey/core/ptz_camera.h"
#include "marey/core/rig.h"

namespace marey::format::rig {

/// Reads `time,pan,tilt,focal,pan_sd,tilt_sd,focal_sd,pan_tilt,pan_focal,tilt_focal`: s by the camera's clock, degrees, px of a
/// image of `size`, standard deviations and correlations; a row with a time alone is a frame where the camera is lost. Nothing of
/// the tripod is in it. Throws Error with the line for what is not one of this, and for times that do not ascend.
std::vector<PtzCamera::Turn> parse_ptz(std::string_view text, const std::string& name, cv::Size size);

std::string ptz_text(const PtzCamera& camera, cv::Size size);

/// How each camera of a rig file is turned, in the file's order; nothing for one that stands (`turns`, `tripod`, `lean`,
/// `nodal_offset` and `bend` of a camera, docs/rig.md). Throws Error with every problem of the file.
std::vector<std::shared_ptr<const PtzCamera>> read_ptz(const std::string& rig_path);

/// Writes a rig file as `write_rig` does, the rotations of each of its PTZ cameras in a file beside it, RIG_CAMERA_ptz.csv.
/// `turning` as `read_ptz` gives it; such a camera has its size. Throws Error if that cannot be.
void write_ptz_rig(const Rig& rig, const std::vector<std::shared_ptr<const PtzCamera>>& ptz, const std::string& path);

}  // namespace marey::format::rig
