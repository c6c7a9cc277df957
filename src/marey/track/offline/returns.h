// Who left the image and came back.
//
// A tracklet that ends at the border and a later one that begins there may be one person. Evidence: the appearance of the clothes
// (wardrobe.h), the position along the border, and the time away: people return within seconds, near the point of exit. The
// alternative is a new person. The fraction of people who return, the rate of new people and how near people return are estimated
// from those pairs alone that clothes identify, without the border and without learned rates: nothing is accepted on evidence
// that it produced itself. Where people are not distinguishable by clothes (two teams), all who enter count as new, and
// almost none are linked. Appearance is compared with that of others: people observed at the same time are different people.
// One assignment decides; pairs whose probability over all assignments is high are linked. Recordings with few entries need
// sufficient evidence from clothes (returns.cpp).
// The gap is not filled.
// Cost: pairs of an end and a beginning within the longest time away.
#pragma once

#include <span>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/track/offline/tracklet_log.h"

namespace marey::track::offline {

struct ReturnOptions {
  double longest_away = 15;       ///< s
  double shortest_away = 0.4;     ///< s
  double typically_away = 5;      ///< s: a person comes back at any time up to this, more rarely later
  double min_probability = 0.95;  ///< of a pair, to be joined; above 1: none is
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

/// Finds them. `tracklets` in the order of frames each, in px of their frames' images, none empty; `view` is the image. No
/// tracklet is twice a `before`, nor twice an `after`.
std::vector<Returned> find_returned(std::span<const TrackletLog::Tracklet> tracklets, const TrackletLog& log, const Box& view,
                                    const ReturnOptions& options = {});

/// Joins them; what one person made is in the place of its first.
void join_returned(std::vector<TrackletLog::Tracklet>& tracklets, std::span<const Returned> returned);

}  // namespace marey::track::offline
