// Three methods to estimate where a marker was while it was hidden. Each knows both ends of the gap and meets them.
//   spline   a polynomial through the observations before and after
//   rigid    markers that keep their distances to it carry it along; what it moved among them in the meantime is spread over the
//   gap
//            (Smolka & Lukasiak; the "rigid body fill" of the field)
//   pattern  its place among its rigid partners, distinguished from the places of other markers there by a regression learned from
//   the
//            frames that have them all (principal components: Federolf 2013; Gløersen & Federolf 2016)
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "marey/core/geometry.h"

namespace marey::edit {

/// Frames of a piece of a recording, counted from its beginning; both ends included.
struct Hole {
  std::size_t first = 0, last = 0;

  std::size_t size() const { return last - first + 1; }
};

/// Places over a piece of a recording at an even rate.
struct Locations {
  struct Marker {
    std::vector<Vector<3>> location;  ///< m; meaningless where it is not known
    std::vector<char> known;

    /// Whether it is known throughout, and just before and after.
    bool spans(const Hole& hole) const;
  };

  double rate_hz = 0;
  std::vector<Marker> markers;

  std::size_t size() const { return markers.empty() ? 0 : markers.front().location.size(); }
};

/// The markers by which `marker` can be reported within the hole, the most rigid first, twelve at most. Distances are compared over
/// all frames that have both.
std::vector<std::size_t> donors_of(const Locations& locations, std::size_t marker, const Hole& hole);

/// Places of frames hole.first to hole.last; nothing if the method cannot say: the marker is not known before or after, there
/// are not three donors off one line, or too few frames to learn from. `hidden` is not learned from, beside the hole itself.
std::optional<std::vector<Vector<3>>> spline_fill(const Locations& locations, std::size_t marker, const Hole& hole);
std::optional<std::vector<Vector<3>>> rigid_fill(const Locations& locations, std::size_t marker, const Hole& hole,
                                                 std::span<const std::size_t> donors);
std::optional<std::vector<Vector<3>>> pattern_fill(const Locations& locations, std::size_t marker, const Hole& hole,
                                                   std::span<const std::size_t> donors, const Hole& hidden);

}  // namespace marey::edit
