#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "marey/core/time.h"
#include "marey/track/ground/offline/ground_join.h"
#include "marey/track/ground/offline/ground_recorder.h"

namespace marey::track::ground::offline {

/// When the instants of a recording were, and from which one on each camera gave frames.
struct GroundInstants {
  std::span<const std::int32_t> frames;
  std::span<const Timestamp> times;
  std::span<const std::int32_t> camera_begins;
};

/// People from chains of tracklets (ground_join.h): false alarms dropped, paths smoothed, gaps filled, ids given from 1 in the
/// order of chains. A person seen from the first frame of a camera that was started late was there before: that is predicted.
/// Tracklets are used up, chain by chain, so that memory holds either them or what is made of them. Cost: linear in the samples.
GroundRecorder::Joined people_from_chains(std::vector<GroundTracklet> tracklets, const std::vector<GroundChain>& chains,
                                          const GroundInstants& instants, const GroundJoinOptions& options);

}  // namespace marey::track::ground::offline
