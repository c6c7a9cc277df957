// Who left the picture and came back.
//
// A tracklet that ends where somebody walks out of the picture, and one that begins where somebody walks in, may be one person's
// though minutes of motion say nothing of it any more. What tells are the clothes (wardrobe.h), the place at the border, and the
// time: people are away for seconds rather than minutes, and come in again near where they went out, the nearer the sooner (how
// near is learned too). Against
// that stands that somebody else comes: how often, and where along the border, is learned from the recording, and so is how many of
// those who leave come back at all, by turns with who that is. One assignment decides; of its pairs those are joined whose
// probability over all assignments is high. What the decision rests on, it did not make: clothes of those who were there at the
// same time are other people's for sure, and where clothes say nothing, place and time alone hardly ever suffice.
// Nothing is said of where they were meanwhile.
// Cost: pairs of an end and a beginning within the longest time away.
#pragma once

#include <span>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/track/tracklet_log.h"

namespace marey::track {

struct ReturnOptions {
  double longest_away = 15;         ///< s
  double shortest_away = 0.4;       ///< s
  double usually_away = 5;          ///< s: who comes back does so at any time up to this, more seldom later
  double least_probability = 0.95;  ///< of a pair, to be joined; above 1: nobody is
  double along = 0.06;    ///< heights along the border for each second away, at its sides; a person walks away from us there
  double across = 0.4;    ///< the same at its top and bottom
  double anywhere = 0.1;  ///< share of those who come back anywhere along the border
};

/// Two tracklets that are one person's.
struct Returned {
  int before = 0, after = 0;  ///< indices
  double away = 0;            ///< s
  double probability = 0;
};

/// Finds them. `tracklets` in the order of frames each, in px of their frames' pictures, none empty; `view` is the picture. No
/// tracklet is twice a `before`, nor twice an `after`.
std::vector<Returned> find_returned(std::span<const TrackletLog::Tracklet> tracklets, const TrackletLog& log, const Box& view,
                                    const ReturnOptions& options = {});

/// Joins them; what one person made is in the place of its first.
void join_returned(std::vector<TrackletLog::Tracklet>& tracklets, std::span<const Returned> returned);

}  // namespace marey::track
