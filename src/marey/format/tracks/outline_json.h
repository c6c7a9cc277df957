#pragma once

#include <string>

#include "marey/core/outline.h"

namespace marey::format::tracks {

/// Appends an outline as a JSON object, on one line: {"state": "seen" | "partly" | "held", "order": k,
/// "control_points": [[x, y], …], "deviations": [[x, y], …], "centre": [x, y], "velocity": [x, y], "scale_rate": s, "silhouette":
/// [x, y], "centre_deviation": [x, y], "velocity_deviation": [x, y], "scale_rate_deviation": s}. px, px/s, 1/s; pixels count from
/// 0. "silhouette" is the centre of the area that was seen, where the target was seen alone. Measurement lines, which serve the
/// frame alone, are omitted.
void append_json(std::string& text, const Outline& outline);

}  // namespace marey::format::tracks
