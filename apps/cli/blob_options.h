#pragma once

#include <optional>

#include "marey/detect/markers/marker_detector.h"

#include "command_line.h"

namespace marey::cli {

void add_threshold(Command& command, std::optional<double>& threshold);

/// What a marker's blob looks like: --threshold, --dark, --min-area, --max-area, --min-roundness.
void add_blob_options(Command& command, detect::markers::MarkerOptions& markers);

}  // namespace marey::cli
