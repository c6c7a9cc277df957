#pragma once

#include <string>

#include "marey/core/keypoints.h"

namespace marey::format::tracks {

/// Appends a person's body points as a JSON object, on one line: {"presence": p, "points": {"nose": [x, y, sd, visibility,
/// presence], …}}. px; sd is the root of the covariance's mean variance; what is not known is omitted.
void append_json(std::string& text, const Keypoints<2>& body, const KeypointSet& set);

}  // namespace marey::format::tracks
