#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/filter/filters.h"
#include "marey/track/tracker.h"

namespace marey::track::roster {

/// Lengths in the unit of the observations: px in the image, m in space.
struct RosterTrackerOptions {
  filter::FilterOptions filter = filter::InteractingModelsOptions{};
  std::vector<std::string> labels;  ///< names for the points of the first frame, left to right, those in one column top to bottom
  double max_speed = 6000;          ///< no marker moves faster, px/s
  double marker_width = 8;          ///< of an observation without a box, px
  double position_noise = 0.05;     ///< standard deviation added to that of each observation, px: what no detector knows of itself
  bool rigid_neighbours = false;    ///< in space: a hidden marker is expected where the markers that move rigidly with it are
  double decide_after = 0;          ///< in space: what `decided` says is that old, s, and names are corrected in the meantime
  std::optional<Box> image;         ///< a hidden marker is predicted no farther than this, px; nothing: for some seconds
  double confirm = 10;              ///< log-likelihood ratio against clutter that proves a newcomer
};

/// Follows named points that are few or many, alike, and always the same: markers on a body. A point seen in the first frame
/// is on the roster and never given up: a target that vanishes is waited for, and what then appears unexplained is taken to be it.
/// Throws Error if there are more labels than points in the first frame, or a label occurs twice.
template <int D>
std::unique_ptr<Tracker<D>> make_roster_tracker(const RosterTrackerOptions& options);

}  // namespace marey::track::roster
