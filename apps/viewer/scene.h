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
  std::optional<bool> y_down = {};                ///< nothing: as the recording has it
  bool centred = false;
};

/// What the page can do beyond display.
struct SceneCan {
  bool show_video = false;
  bool edit = false;
};

/// A recorded scene as JSON: what does not change from instant to instant, and the known part of the recording so far. The fields
/// are those that page/src/scene.ts declares.
std::string scene_text(const RecordingHeader& header, const RecordingState& state, const GroundChoice& ground, const SceneCan& can);

/// A live one: its tracks and their extent so far.
struct LiveScene {
  std::vector<TrackName> names;
  GroundChoice ground = {};  ///< of people on it
  std::optional<Extent> extent = {};
  bool can_record = false;
  bool can_change = false;    ///< cameras and names
  std::string rig_file = {};  ///< that changes can be saved in; empty: no such file
  std::string job = {};       ///< "wand"; empty for a run that tracks
};
std::string scene_text(const RecordingHeader& header, const LiveScene& live);

}  // namespace marey::viewer
