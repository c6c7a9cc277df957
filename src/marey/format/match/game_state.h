#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "marey/core/game_state.h"

namespace marey::format::match {

/// The images of a clip that are evaluated.
struct LabelledImages {
  std::int64_t clip = 0;             ///< the image ids without their last six digits
  std::vector<std::int32_t> frames;  ///< of images whose people, pitch and camera are labelled; ascending, from 0
};

/// The truth of one clip.
struct TrueGameState {
  GameState state;
  LabelledImages images;
};

/// SoccerNet's Labels-GameState.json, as `sn-trackeval` 0.4.0 reads it: people of labelled images, without the ball. Throws Error
/// for what that program refuses (a role, team or number that the task does not know, a person without a place, an id twice in an
/// image) and for anything malformed.
TrueGameState read_true_game_state(const std::string& path);

/// A tracker's predictions for that clip; those of other images are dropped. Images are those of the truth, by the same
/// ids; by Marey's ids, which name no clip; or by the short ids of the first release, which count from 0. Throws Error likewise.
GameState read_predicted_game_state(const std::string& path, const LabelledImages& images);

// Of text in memory, which messages call `name`.
TrueGameState parse_true_game_state(std::string_view text, const std::string& name);
GameState parse_predicted_game_state(std::string_view text, const std::string& name, const LabelledImages& images);

/// Whether a file may be a game state; false if it cannot be read.
bool is_game_state(const std::string& path);

}  // namespace marey::format::match
