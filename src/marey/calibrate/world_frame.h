#pragma once

#include <string>
#include <vector>

#include "marey/calibrate/bundle/bundle.h"
#include "marey/calibrate/wand/wand.h"

namespace marey::calibrate {

/// Moves a bundle: what was at `p` is at scale · (rotation p + translation) then. Cameras keep what they see.
void move(bundle::Bundle& bundle, const Rigid3& moved_from_world, double scale);

/// Chooses the world of a fitted rig and its scale, and says so in `notes`: where the input's cameras had poses, the world stays
/// where these have it; else z is up as the images are, and the origin is in the middle of the observations. A single light's scale
/// comes from the known distance, else from the given poses, else the first two cameras are set 1 m apart.
void put_into_world(bundle::Bundle& bundle, const wand::WandInput& input, const wand::WandOptions& options,
                    std::vector<std::string>& notes);

}  // namespace marey::calibrate
