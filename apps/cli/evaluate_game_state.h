#pragma once

#include <string>

namespace marey::cli {

/// Whether both are game states of SoccerNet, or folders of them.
bool are_game_states(const std::string& truth, const std::string& tracks);

/// `marey evaluate` of SoccerNet's game states: GS-HOTA, printed, as JSON on request. Two files, or a folder of clips
/// (CLIP/Labels-GameState.json) and one of predictions (CLIP.json). Throws Error.
void evaluate_game_states(const std::string& truth, const std::string& tracks, bool json, bool quiet);

}  // namespace marey::cli
