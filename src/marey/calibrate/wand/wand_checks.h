#pragma once

#include <vector>

#include "marey/calibrate/wand/wand.h"
#include "marey/calibrate/wand/wand_table.h"

// What cannot become a rig is refused here, each with its cause and what to do. All throw Error.

namespace marey::calibrate::wand {

/// Cameras, sizes, lenses and the wand itself.
void check_wand_input(const WandInput& input, const WandOptions& options);

/// That every camera saw the wand often enough.
void check_tracks(const WandInput& input, const std::vector<MarkTrack>& tracks);

/// That the wand's measured length, in order of time, is one length: m, measured by `scale` times the observations.
void check_lengths(const std::vector<double>& lengths, const MarkerLine& wand);

/// That the cameras stand apart, and the wand was moved through a volume.
void check_fitted_rig(const WandInput& input, const bundle::Bundle& bundle, const bundle::BundleResult& fit);

}  // namespace marey::calibrate::wand
