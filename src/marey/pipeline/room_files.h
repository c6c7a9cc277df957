#pragma once

#include <functional>
#include <string>

#include "marey/simulate/room/room.h"

namespace marey::pipeline {

struct RoomFilesOptions {
  bool videos = false;           ///< renders camN.mp4, and makes it each camera's source
  double marker_radius = 0.007;  ///< m, for videos
  double picture_noise = 0.7;    ///< standard deviation of the pixels, grey levels
};

/// Writes a simulated room into a folder, which must exist:
///   rig.toml          the true rig; rig_after.toml too, where a camera is bumped
///   start.toml        what is known before a calibration: names, sizes, rates, lenses
///   observations.csv  camera,frame,x,y: what the cameras report, from top to bottom in each picture
///   blobs.csv         the same rows with their markers: camera,frame,x,y,marker (blank for ghosts)
///   labels.csv        label,x,y,z: where each marker is at the beginning, m
///   truth.csv         frame,time,label,x,y,z,cameras: m, by the rig's clock; by how many cameras it can be seen
/// Memory does not grow with the length. `progress` may be empty. Throws Error where a file cannot be written.
void write_room(const simulate::room::RoomScene& scene, const std::string& folder, const RoomFilesOptions& options = {},
                const std::function<void(std::int64_t done, std::int64_t all)>& progress = {});

}  // namespace marey::pipeline
