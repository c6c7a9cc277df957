#pragma once

#include <optional>
#include <string>
#include <vector>

#include "marey/core/recording.h"
#include "marey/geometry/pitch.h"

#include "stored_recording.h"

namespace marey::viewer {

/// What the user says of a ground.
struct GroundChoice {
  std::optional<geometry::PitchSize> pitch = {};  ///< nothing: guessed from where people are, 105 × 68 m
  bool y_down = false;
  bool centred = false;
};

/// A recorded scene as JSON: what does not change from instant to instant, and what is known of the recording so far. The fields
/// are those that page/src/scene.ts declares.
std::string scene_text(const RecordingHeader& header, const RecordingState& state, const GroundChoice& ground, bool has_film);

/// A live one: tracks are named as they come.
struct LiveScene {
  std::vector<TrackName> names;
  bool can_record = false;
};
std::string scene_text(const RecordingHeader& header, const LiveScene& live);

}  // namespace marey::viewer
