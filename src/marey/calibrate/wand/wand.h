// A rig from a wand, or a single light, that was waved before its cameras.
//
//   1. find the wand in each view (wand_marks)
//   2. compare the clocks (wand_offsets), relate the cameras by a few hundred instants (grow_rig); where lenses are not known, for
//   several guesses of their focal length
//   3. search again in every view for what the first step could not find, now that it is known where the wand must be
//   4. adjust everything, time offsets too, outliers put out; on most of the frames first, to be evaluated on the others, then on
//   all
//   5. where the lenses as given explain less than refined ones would, free them and do 3 and 4 again
//   6. report, and put the world where the given poses have it, or upright as the cameras stand
// Cost: dominated by 4, linear in the views of markers.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "marey/calibrate/rig_report.h"
#include "marey/calibrate/wand/wand_marks.h"
#include "marey/core/hooks.h"
#include "marey/core/rig.h"

namespace marey::calibrate::wand {

/// What happens to the lenses.
enum class LensUse {
  automatic,  ///< held where they explain the observations as well as refined ones do, else refined; estimated where not given
  fixed,      ///< held; each camera's has to be given
  refined     ///< refined
};

struct KnownDistance {
  std::string first, second;  ///< names of cameras
  double metres = 0;
};

struct WandInput {
  Rig rig;  ///< sizes, lenses where known, poses where the world is to stay where it is
  MarkerLine wand;
  std::vector<std::vector<BlobFrame>> detected;  ///< by camera, in order of time
};

struct WandOptions {
  LensUse lens = LensUse::automatic;
  bool find_offsets = true;                    ///< whether cameras may have been started at other times than their offsets say
  std::optional<KnownDistance> distance = {};  ///< of two cameras: what a single light's scale comes from
  std::uint64_t seed = 1;
};

struct WandResult {
  Rig rig;
  RigReport report;
  std::vector<std::string> notes;  ///< what was decided, and what the user should know
};

/// Throws Error, with the cause and what to do, for what cannot become a rig: no common view, a wand in a plane, cameras in one
/// place, too few poses, a wrong wand; Stopped.
WandResult calibrate_wand(const WandInput& input, const WandOptions& options = {}, const Hooks& hooks = {});

}  // namespace marey::calibrate::wand
