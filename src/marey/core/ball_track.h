#pragma once

#include <string_view>

#include "marey/core/instant.h"

namespace marey {

/// What the ball's track is called in a recording of people on the ground. It has no team, and its positions have heights where
/// those of people have none: its columns are of three dimensions.
inline constexpr std::string_view kBallLabel = "ball";

inline bool is_ball(const TrackName& name) {
  return name.label == kBallLabel && name.team.empty();
}

}  // namespace marey
