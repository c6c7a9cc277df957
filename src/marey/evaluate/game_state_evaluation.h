#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "marey/core/game_state.h"
#include "marey/evaluate/evaluation.h"
#include "marey/evaluate/hota.h"
#include "marey/files/limits.h"

namespace marey::evaluate {

/// What two people must have in common, besides their place, to be the same. Each includes those before it.
enum class GameStateDetail { positions, roles, teams, numbers };
inline constexpr std::size_t game_state_details = 4;

/// The counts of one clip, or of several added up.
struct GameStateEvaluation {
  std::array<HotaCounts, game_state_details> counts;
  std::int64_t true_people = 0, track_people = 0;  ///< places of people, not different people

  GameStateEvaluation& operator+=(const GameStateEvaluation& other);
  HotaScores scores(GameStateDetail detail) const { return counts[static_cast<std::size_t>(detail)].scores(); }
  /// The task's official figure.
  HotaScores gs_hota() const { return scores(GameStateDetail::numbers); }
};

/// The distance at which two people are alike by 0.05, the least that HOTA lets match: m.
inline constexpr double game_state_tolerance = 5;

/// GS-HOTA (V. Somers et al., CVPR Workshops 2024), as sn-trackeval 0.4.0 counts it: HOTA with the similarity exp(−d² / 2σ²) of two
/// places, 0.05 at `game_state_tolerance`, and 0 where role, team or shirt number differ. Both are ordered by frame, and an id
/// stands once a frame. Four times the cost of `evaluate`. Throws Error if a frame is crowded beyond `limits`.
GameStateEvaluation evaluate_game_state(std::span<const PitchPerson> truth, std::span<const PitchPerson> tracks,
                                        const Limits& limits = Limits::in_force());

}  // namespace marey::evaluate
