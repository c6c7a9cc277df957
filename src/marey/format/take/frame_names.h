#pragma once

#include <optional>
#include <string_view>

#include "marey/core/recording.h"

namespace marey::format::take {

/// A frame of reference, as a take calls it: "image", "ground", "user_ground", "space".
std::string_view name_of(FrameOfReference::Kind kind);
/// Nothing for a name that is not one of them.
std::optional<FrameOfReference::Kind> frame_kind_of(std::string_view name);

}  // namespace marey::format::take
