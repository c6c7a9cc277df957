#pragma once

#include <cstdint>
#include <string>

#include "marey/core/hooks.h"
#include "marey/simulate/match/match_camera.h"

namespace marey::pipeline::simulate {

struct MatchFilesOptions {
  marey::simulate::match::MatchCamerasOptions cameras;
  marey::simulate::match::MatchDetectorOptions detector;
  std::uint64_t seed = 1;
  double seconds = 60;  ///< positive
  bool boxes = true;    ///< what a detector says of each camera
  bool videos = false;  ///< what each camera videos, and clicks on its image
  marey::simulate::match::MatchVideoOptions video;
  double click_noise = 1;     ///< px, standard deviation in each axis
  int wrong_clicks = 0;       ///< of each camera
  bool hide_offsets = false;  ///< rig.toml says nothing of when cameras were started; true_rig.toml does
};

/// Writes a simulated match into a folder, which must exist:
///   rig.toml        the exact cameras, with their videos as sources, else with their boxes as detections
///   truth.csv       where every person is at the first camera's frames (format/match/ground_file.h), in the pitch's own frame;
///                   `cameras` are those for which the target is in the image and not hidden
///   CAM_truth.txt   MOTChallenge truth for each camera: the box of each whole person, cut at the image's border; ids as in
///                   truth.csv; the ninth column is the share of it that can be seen
///   CAM.txt         with `boxes`: MOTChallenge detections for each camera; with videos too, boxes.toml is the rig that names them
///   CAM.mp4         with `films`: what each camera records, H.264
///   ball.csv        with a ball in the videos, where it is at the first camera's frames: frame,time,x,y,z,vx,vy,vz,state,holder;
///                   z is that of its centre above the ground; state is held, rolling, flying or dead; holder is an id of
///                   truth.csv; no row while a person fetches it
///   CAM_ball.csv    with a ball in the videos, what each camera sees of it: frame,x,y,radius,visible; px, and the share of its
///   disc CAM_clicks.csv  with `films`: x,y,u,v of places on the pitch that were clicked, with which start.toml, the rig without
///   its
///                   calibration, can be calibrated
/// Memory does not grow with the length. Throws Error if an option is out of its domain or a file
/// cannot be written.
void write_match(const MatchFilesOptions& options, const std::string& folder, const Hooks& hooks = {});

}  // namespace marey::pipeline::simulate
