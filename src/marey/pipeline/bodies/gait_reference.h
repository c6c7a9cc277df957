// A control group to compare a walk with: a folder of recordings, read as the walk itself is.
//
// Each folder within it is a person: walks, and a static trial whose name contains "static" or "standing". Recordings directly
// in it are one person each, without a static trial. A cycle that turns is omitted: the group is of straight walking.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "marey/analyse/gait/gait_profile.h"
#include "marey/core/hooks.h"

namespace marey::pipeline::bodies {

struct GaitOptions;

struct GaitReference {
  std::string folder;
  std::vector<analyse::gait::ReferencePerson> people;
  std::vector<analyse::gait::ReferenceBand> bands;
  std::vector<analyse::gait::ReferenceSignal> signals;
  std::vector<analyse::gait::ReferenceFigure> figures;
  std::vector<analyse::gait::ReferenceScore> scores;  ///< of people of the group against its others
  std::size_t walks = 0, cycles = 0, curved = 0;      ///< curved: omitted cycles
  std::vector<std::string> warnings;                  ///< recordings that are omitted, and why
};

/// With the axis that is up, and the steps' options, of `options`. Throws Error if the folder has no walk that can be used, with
/// the reason of its first file.
GaitReference read_gait_reference(const std::string& folder, const GaitOptions& options, const Hooks& hooks = {});

/// The person of the group who walks in the recording, too: it lies in their folder, or is one of their files. Nothing if they are
/// others, as far as files show.
std::optional<std::string> walker_in_reference(const std::string& folder, const std::string& recording);

/// Rad; a cycle that turns by more is not in a reference.
double max_reference_turn();

}  // namespace marey::pipeline::bodies
