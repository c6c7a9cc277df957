#pragma once

#include <optional>
#include <string>

#include "marey/pipeline/markers/markers_in_picture.h"

#include "command_line.h"

namespace marey::cli {

/// What `marey track --targets markers` understands beyond what people need.
struct MarkerFlags {
  std::string labels;
  std::string colour;
  std::optional<double> saturation;
  std::string mask;
  bool fit_noise = false;
  detect::markers::MarkerOptions limits;  ///< the blobs, and the time of the automatic mask
};

void add_marker_options(Command& command, MarkerFlags& flags);
/// Of these, what a detector alone needs.
void add_detector_options(Command& command, MarkerFlags& flags);

/// Reads the files that the flags name. Throws Error where one cannot be read.
detect::markers::MarkerOptions detector_options(const MarkerFlags& flags);
pipeline::markers::MarkersInPictureOptions marker_options(const MarkerFlags& flags, const std::string& filter, bool live);

}  // namespace marey::cli
