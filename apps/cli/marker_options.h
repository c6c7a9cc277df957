#pragma once

#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "marey/pipeline/track_markers.h"

namespace marey::cli {

/// What `marey track --targets markers` understands beyond what people need.
struct MarkerFlags {
  std::string labels;
  std::optional<double> threshold;
  std::string colour;
  std::optional<double> saturation;
  std::string mask;
  bool dark = false;
  bool fit_noise = false;
  detect::markers::MarkerOptions limits;  ///< its areas, roundness and time of the automatic mask
};

void add_marker_options(CLI::App& command, MarkerFlags& flags);

/// Reads the files that the flags name. Throws Error where one cannot be read.
pipeline::TrackMarkersOptions marker_options(const MarkerFlags& flags, const std::string& filter, bool live);

}  // namespace marey::cli
