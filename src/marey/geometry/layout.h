// Which of the seen points are the markers of a known layout: the rigid motion under which most of the layout falls on points.
//
// Three markers of the layout that lie far apart and not in a line are searched for among the points by their distances; each
// triangle found proposes a motion, which is refined over all markers that then have a point within the tolerance. The motion with
// most markers wins; of equals, as those of a symmetric layout are, the one that turns the layout's axes the least: a layout should
// be written about as it will lie in the world. Points may be missing and false ones among them.
// Cost: points² for a pair of the right distance, and points × layout for each triangle found; some ms for 50 markers.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "marey/geometry/rigid.h"
#include "marey/geometry/vector.h"

namespace marey::geometry {

struct LayoutMatch {
  Rigid3 world_from_layout;
  std::vector<std::optional<int>> point_of;  ///< by marker of the layout: the point it falls on
  int matched = 0;
  double rms = 0;  ///< m, of the matched
};

/// Nothing if fewer than three markers, or fewer than `share` of the layout, have a point within `tolerance` m.
std::optional<LayoutMatch> match_layout(std::span<const Vector<3>> layout, std::span<const Vector<3>> points, double tolerance,
                                        double fraction = 0.6);

/// The motion that takes `from` nearest to `to`, pair by pair, in least squares: at least three that do not lie in a line (Arun,
/// Huang, Blostein 1987).
Rigid3 rigid_fit(std::span<const Vector<3>> from, std::span<const Vector<3>> to);

}  // namespace marey::geometry
