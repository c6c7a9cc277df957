#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "marey/core/time.h"
#include "marey/track/ground/ground_recorder.h"

namespace marey::track::ground {

/// People from chains of tracklets (ground_join.h): false alarms dropped, paths smoothed, gaps filled, ids given from 1 in the
/// order of chains. `frames` and `times` by instant. Tracklets are used up, chain by chain, so that memory holds either them or
/// what is made of them. Cost: linear in the samples.
GroundRecorder::Joined people_from_chains(std::vector<GroundTracklet> tracklets, const std::vector<std::vector<int>>& chains,
                                          std::span<const std::int32_t> frames, std::span<const Timestamp> times,
                                          const GroundJoinOptions& options);

}  // namespace marey::track::ground
