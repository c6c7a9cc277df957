#pragma once

#include <cstdint>
#include <string>

#include "marey/core/hooks.h"
#include "marey/simulate/square/square_boxes.h"
#include "marey/simulate/square/square_motion.h"

namespace marey::pipeline::simulate {

struct SquareFilesOptions {
  marey::simulate::square::SquareOptions square;
  marey::simulate::square::SquareDetectorOptions detector;
  int cameras = 7;       ///< 1 to 64
  double rate_hz = 2;    ///< frames a second
  double seconds = 180;  ///< positive
  std::uint64_t seed = 1;
};

/// Writes an open square with people who come and leave into a folder, which must exist:
///   rig.toml   the exact cameras, with their boxes as detections
///   truth.csv  where every person in the square is at each frame (format/match/ground_file.h)
///   CAM.txt    MOTChallenge detections of each camera
/// Memory does not grow with the length. Throws Error if an option is out of its domain or a file cannot be written.
void write_square(const SquareFilesOptions& options, const std::string& folder, const Hooks& hooks = {});

}  // namespace marey::pipeline::simulate
