#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "marey/core/observation.h"

namespace marey::simulate {

/// What happens to two people who meet.
enum class Encounter {
  cross,      ///< each runs straight on past the other
  alongside,  ///< they run side by side for a while, then part
  stop,       ///< they stand together for a while, then leave
};

struct EncounterOptions {
  int pairs = 4;             ///< of people; each pair meets again and again
  int close_encounters = 4;  ///< of each pair
  double rate_hz = 25;
  std::optional<Encounter> kind = {};  ///< of all meetings; nothing: drawn for each
  double min_noise = 0.1;              ///< m, standard deviation of a place, per axis: drawn for each scene
  double max_noise = 0.4;
  double missed = 0.1;   ///< probability that a person is not seen in a frame
  double clutter = 0.5;  ///< false observations a frame
  double merged = 0.5;   ///< m: two nearer than this are seen as one, between them
  double side = 40;      ///< m, of the ground
};

/// People who meet and part, as one camera sees their places on the ground, with the truth.
struct EncounterScene {
  EncounterOptions options;
  double noise = 0;                                   ///< m
  std::vector<std::vector<Vector<2>>> truth;          ///< by frame, by person; all are there in all frames; m
  std::vector<std::vector<Observation<2>>> detected;  ///< by frame
};

/// Draws a scene from `seed`, the same on every machine. People run at 2 to 6 m/s, and accelerate by no more than about 6 m/s²;
/// what kind each meeting is, where and how, is drawn.
EncounterScene simulate_encounters(std::uint64_t seed, const EncounterOptions& options = {});

}  // namespace marey::simulate
