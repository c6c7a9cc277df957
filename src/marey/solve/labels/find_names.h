// Names for tracks that are followed live, out of nothing: what `label_recording` finds in the last seconds.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "marey/core/hooks.h"
#include "marey/core/recording.h"
#include "marey/solve/labels/label_recording.h"
#include "marey/solve/labels/label_tracker.h"

namespace marey::solve::labels {

struct FoundNames {
  std::map<TrackId, int> name_of;         ///< of the tracks that had a name when the recording ended, as it found them last
  std::unique_ptr<LabelTracker> tracker;  ///< that continues with the distances that were found
  double scale = 1;                       ///< of the subject against the learned set
  /// By name: not 0 if it is undecided as `Labelled` has it, or no track has it and it is the best of one that stayed without a
  /// name.
  std::vector<char> undecided;
  std::vector<char> decided;        ///< by name: not 0 if a track had it, whether it is still there or not
  double misfit = 0, misfit_m = 0;  ///< as `Labelled` has them
};

/// `recent`: tracks in space over some seconds. Takes about as long as `label_recording`: for a task of its own. `learned` must
/// outlive what comes out. Throws Error if too few of the set's markers can be reported.
FoundNames find_names(const Recording& recent, const LearnedMarkers& learned, const LabelOptions& options,
                      const LabelTrackerOptions& tracking, const Hooks& hooks = {});

}  // namespace marey::solve::labels
