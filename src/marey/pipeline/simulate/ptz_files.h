#pragma once

#include <cstdint>
#include <string>

#include "marey/core/hooks.h"
#include "marey/simulate/match/ptz_match.h"

namespace marey::pipeline::simulate {

struct PtzFilesOptions {
  marey::simulate::match::PtzMatchOptions match;
  marey::simulate::match::MatchDetectorOptions detector;
  std::uint64_t seed = 1;
  double seconds = 20;       ///< positive
  double click_noise = 1.5;  ///< px, standard deviation in each axis
  double clicked_from = 0;   ///< s: no frame before is clicked
  int clicked_frames = 4;    ///< at most, that face different sides
  int clicks = 100;          ///< in a frame, at most
};

/// Videos a match with a main PTZ camera, into a folder, which must exist:
///   main.mp4        what it videos, H.264
///   rig.toml        the exact camera, its turns beside it, with the video as source
///   clicks.csv      frame,x,y,u,v: what a user would click in four frames that face different sides
///   boxes.txt       MOTChallenge detections: what a detector says of the main camera's frames
///   truth.csv       where every person is at each frame (format/match/ground_file.h)
/// Throws Error if an option is out of its domain or a file cannot be written; Stopped.
void write_ptz_match(const PtzFilesOptions& options, const std::string& folder, const Hooks& hooks = {});

}  // namespace marey::pipeline::simulate
