#include "marey/evaluate/game_state_evaluation.h"

#include <cmath>

#include "marey/evaluate/frame_walk.h"
#include "marey/evaluate/pair_table.h"

namespace marey::evaluate {
namespace {

bool same_person(const PitchPerson& a, const PitchPerson& b, GameStateDetail detail) {
  if (detail >= GameStateDetail::roles && a.role != b.role) return false;
  // Without roles, sn-trackeval compares teams and numbers as the file has them; here each detail includes those before it.
  if (detail >= GameStateDetail::teams && a.team != b.team) return false;
  return detail < GameStateDetail::numbers || a.jersey == b.jersey;
}

HotaCounts count_hota(std::span<const PitchPerson> truth, std::span<const PitchPerson> tracks, GameStateDetail detail,
                      const Limits& limits) {
  const double sigma = std::sqrt(game_state_tolerance * game_state_tolerance / (-2 * std::log(0.05)));
  const auto close = [&](const PitchPerson& a, const PitchPerson& b) {
    const double distance = (a.location - b.location).norm();
    const double scaled = distance / sigma;
    return Closeness{distance, same_person(a, b, detail) ? std::exp(-0.5 * (scaled * scaled)) : 0.0};
  };
  const IdNumbers objects(truth), names(tracks);
  PairTable pairs(objects.count());
  HotaCounter hota(objects.count(), names.count(), pairs);
  for (FrameWalk<PitchPerson, decltype(close)> frame(truth, tracks, objects, names, close, limits); frame.next();)
    hota.observe_frame(frame);
  hota.align();
  for (FrameWalk<PitchPerson, decltype(close)> frame(truth, tracks, objects, names, close, limits); frame.next();)
    hota.match(frame);
  return hota.counts();
}

}  // namespace

GameStateEvaluation& GameStateEvaluation::operator+=(const GameStateEvaluation& other) {
  for (std::size_t i = 0; i < counts.size(); ++i) counts[i] += other.counts[i];
  true_people += other.true_people;
  track_people += other.track_people;
  return *this;
}

GameStateEvaluation evaluate_game_state(std::span<const PitchPerson> truth, std::span<const PitchPerson> tracks,
                                        const Limits& limits) {
  GameStateEvaluation result;
  result.true_people = static_cast<std::int64_t>(truth.size());
  result.track_people = static_cast<std::int64_t>(tracks.size());
  for (std::size_t i = 0; i < game_state_details; ++i)
    result.counts[i] = count_hota(truth, tracks, static_cast<GameStateDetail>(i), limits);
  return result;
}

}  // namespace marey::evaluate
