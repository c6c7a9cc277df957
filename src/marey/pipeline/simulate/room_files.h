// A simulated room as files.
#pragma once

#include <string>

#include "marey/core/hooks.h"
#include "marey/simulate/room/room_keypoints.h"
#include "marey/simulate/room/room_video.h"

namespace marey::pipeline::simulate {

struct RoomFilesOptions {
  bool videos = false;   ///< renders camN.mp4, and makes it each camera's source
  bool unnamed = false;  ///< unnamed.csv too
  marey::simulate::room::RoomVideoOptions video;
  bool keypoints = false;  ///< what a network for body keypoints finds, and the truth
  marey::simulate::room::KeypointErrors keypoint_errors;
};

/// Writes a simulated room into a folder, which must exist:
///   rig.toml          the true rig; rig_after.toml too, where a camera is bumped
///   start.toml        the data available before a calibration: names, sizes, rates, lenses
///   observations.csv  camera,frame,x,y: what the cameras report, from top to bottom in each image
///   blobs.csv         the same rows with their markers: camera,frame,x,y,marker (blank for ghosts)
///   labels.csv        label,x,y,z: where each marker is at the beginning, m
///   truth.csv         frame,time,label,x,y,z,cameras: m, by the rig's clock; by how many cameras it can be seen
///   skeleton.toml     the body that has the markers, where one does; skeleton2.toml that of a second person, …
///   angles.csv        frame,time and the body's coordinates: degrees, of the pelvis' place m; angles2.csv, …
///   bodies.toml       the rigid bodies, where there are any
///   poses.csv         where all bodies and segments are, as `marey convert --format poses` writes them
///   unnamed.csv       frame,time,id,label,x,y,z of what two cameras see, as a system gives it that knows no names: tracks end at
///                     gaps, ghosts are among them
///   keypoints_camN.json, keypoints_truth.csv: people's body keypoints (COCO), and frame,time,label,x,y,z of the joints; labels
///   have
///                     "P1:", … where there are several people
/// Memory does not grow with the length, but for keypoints. Throws Error if a file cannot be written, Stopped where it is asked
/// to end; nothing that is begun is left behind then.
void write_room(const marey::simulate::room::RoomScene& scene, const std::string& folder, const RoomFilesOptions& options = {},
                const Hooks& hooks = {});

}  // namespace marey::pipeline::simulate
