#pragma once

#include <span>
#include <string>
#include <vector>

#include "marey/core/geometry.h"

namespace marey::evaluate {

/// Where something is in one frame, under a name.
struct NamedPosition {
  std::string name;
  Vector<2> location = Vector<2>::Zero();  ///< px
};

/// What happened to one true marker's name.
struct LabelFate {
  std::string marker;          ///< its name in the truth
  std::string given;           ///< the name that was on it when it was first seen; empty if none was
  int visible = 0;             ///< frames in which the marker can be seen
  int named = 0;               ///< of these, frames with the given name on it
  bool named_at_last = false;  ///< whether the given name is on it in its last visible frame
  bool lost() const { return !named_at_last || 10 * named < 9 * visible; }
};

/// Evaluates names by the rule of `marey experiment trackers`: a name is lost where it is not on its marker in the marker's last
/// visible frame, or was on it in less than 90 % of the frames in which it can be seen. A name is on a marker where it is reported
/// within `reach` px of it. `truth[i]` holds the visible markers of frame i, `tracks[i]` what was reported; both have as many
/// frames.
std::vector<LabelFate> evaluate_labels(std::span<const std::vector<NamedPosition>> truth,
                                       std::span<const std::vector<NamedPosition>> tracks, double reach);

}  // namespace marey::evaluate
