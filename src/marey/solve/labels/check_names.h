// Whether names that were found stand against others that the same points could have, by what the set was taught alone.
//
// While names are found, distances of the recording at hand take the place of the learned ones. That lets a set fit that knows
// little, and also a wrong answer fit itself. So at the end the names are held against the learned distances and sides again,
// together with what a search that moves one name at a time does not reach: two names exchanged, two pairs of a cluster exchanged
// at once (a flat cluster turned over, which keeps its inner distances), three names in a ring, and a row of names along a limb
// shifted by one into an unused name. Of a name the tightest distances count whole, and all others a share, because they
// repeat one posture. Points that lie elsewhere about their neighbours than in the learned posture cost too: half a turn of a head
// is decided by the shoulders. An alternative that is better is taken; one that is barely worse leaves its names undecided.
#pragma once

#include <cstddef>
#include <vector>

#include "marey/core/learned_markers.h"
#include "marey/solve/labels/distance_model.h"
#include "marey/solve/labels/initialise_labels.h"
#include "marey/solve/labels/named_chains.h"

namespace marey::solve::labels {

struct CheckedNames {
  std::vector<int> holder_of;  ///< by name: whose points it is to have, or assign::kNoIndex
  std::vector<int> undecided;  ///< by name: which other name it could as well be exchanged with, or assign::kNoIndex
};

/// `learned_model`: of the learned distances alone. `margin`: log-likelihood by which an alternative must be worse.
CheckedNames check_names(const NamedChains& chains, const LearnedMarkers& learned, const DistanceModel& learned_model,
                         const LabelInitOptions& options, std::size_t neighbours, double margin);

/// How far distances that the set knows as rigid are from the learned ones.
struct Misfit {
  double ratio = 0;  ///< against the distances expected of the training subject: about 1
  double off_m = 0;  ///< median
};

/// Of the three tightest distances of each name; nothing seen is not a misfit.
Misfit misfit_of(const std::vector<DistanceObserved>& named, const DistanceModel& learned_model);

}  // namespace marey::solve::labels
