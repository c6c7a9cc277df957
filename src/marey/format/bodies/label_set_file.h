// set.toml: a marker set as `marey label learn` writes it: how far each two of its markers are from each other, and how much that
// varies.
//
//   labels = ["LFHD", "RFHD", "C7"]
//   moves = true      # false: learned from one who stood still
//   scaled = false    # true: learned from subjects of several sizes
//   places = [[0.1, 0.0, 1.5], …]                # m, one posture
//   distances = [[0.146, 0.0008], [0.21, 0.01], …]  # m, mean and deviation: of 2 and 1, 3 and 1, 3 and 2, …
#pragma once

#include <string>
#include <string_view>

#include "marey/core/learned_markers.h"

namespace marey::format::bodies {

/// Throws Error, `path:LINE: what`, for what is not one.
LearnedMarkers read_label_set(const std::string& path);
LearnedMarkers parse_label_set(std::string_view text, const std::string& name);
std::string label_set_text(const LearnedMarkers& set);
/// Atomically.
void write_label_set(const std::string& path, const LearnedMarkers& set);

}  // namespace marey::format::bodies
