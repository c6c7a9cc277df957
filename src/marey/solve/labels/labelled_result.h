// What comes out of the naming: a track for each name, what stays without one, and how each marker came off.
#pragma once

#include <map>

#include "marey/solve/labels/label_recording.h"
#include "marey/solve/labels/named_chains.h"

namespace marey::solve::labels {

/// Why a chain has no name: the two that come nearest.
struct NameCandidates {
  int best = assign::kNoIndex, next = assign::kNoIndex;
  double fit = 0, margin = 0;
};

/// `doubts` by chain, of those without a name; `scale` of the subject against the learned set.
Labelled labelled_result(const Recording& recording, const LearnedMarkers& learned, const NamedChains& chains,
                         const DistanceModel& model, const std::map<int, NameCandidates>& candidates, double scale);

}  // namespace marey::solve::labels
