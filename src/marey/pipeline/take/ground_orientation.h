// The orientation in which the ground of a file is drawn; see core/ground_transform.h.
#pragma once

#include <optional>
#include <string>

#include "marey/core/recording.h"

namespace marey::pipeline::take {

/// Whether y grows downwards in the ground coordinates of this rig file's users. Throws Error if it says nothing of them.
bool rig_has_y_down(const std::string& rig);

/// What a user should know before the recording of `path` is drawn: nothing in it says whether y grows upwards. Nothing if its
/// format or its rig does, or it is not of the ground.
std::optional<std::string> orientation_unknown(const std::string& path, const RecordingHeader& header);

}  // namespace marey::pipeline::take
