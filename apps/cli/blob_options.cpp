#include "blob_options.h"

namespace marey::cli {

void add_threshold(Command& command, std::optional<double>& threshold) {
  command.number("--threshold", threshold, "grey level", closed(0, 65535),
                 "that a marker's pixels pass (default: from the picture's noise)");
}

void add_blob_options(Command& command, detect::markers::MarkerOptions& markers) {
  add_threshold(command, markers.threshold);
  command.flag("--dark", markers.dark, "markers are darker than what is around them");
  command.number("--widest", markers.widest, "px", closed(2, 200),
                 "markers are no wider, and what is wider is taken out of the picture (default: only where it disturbs)");
  command.whole("--most-markers", markers.most_markers, "N", 1, 1'000'000,
                "a frame; beyond, those expected where they are stay, then the largest");
  command.number("--min-area", markers.min_area, "px^2", closed(0, 1e8), "smallest marker, pixels that pass the threshold");
  command.number("--max-area", markers.max_area, "px^2", closed(0, 1e8), "largest marker, likewise");
  command.number("--min-roundness", markers.min_roundness, "share", closed(0, 1), "from 0, anything, to 1, a disc");
}

}  // namespace marey::cli
