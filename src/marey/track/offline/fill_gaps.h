// Gaps in tracklets, filled in a second pass that knows both ends of each.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "marey/core/time.h"
#include "marey/track/offline/tracklet_log.h"

namespace marey::track::offline {

/// Rows between two measured ones, whose provenance is `filled`.
///   straight  every value on the straight line between both ends: people
///   cubic     places on the cubic through the places and velocities of both ends, the rest as it was guessed: points
enum class GapInterpolation { straight, cubic };

/// Rows between two observed ones are put between them where that lasts at most `longest` seconds; where it lasts longer, before
/// the first and after the last observation it has no rows. `rows` are one target's, in the order of frames; frames may be missing.
void fill_gaps(TrackletLog::Tracklet& rows, const TrackletLog& log, double longest, GapInterpolation method);

/// What a second pass can say of points that were followed by themselves: the tracklets without gaps of up to `longest` seconds.
/// Tracklets seen in less than `fewest` frames are dropped. Rows in the order of frames, then ids. The recording's tracklets are
/// used up.
std::vector<TrackRow> rows_of_points(TrackletLog& log, int min_detections = 3, double longest = 1);

/// Rows of a recording of which only some frames were searched, from rows that count those: `searched[row.frame]` is the frame's
/// index among all, whose times are `times`. Rows on the straight line are put between the rows of a target in two
/// searched frames that follow each other: filled, or predicted if one of both is. Both in the order of frames, then ids.
std::vector<TrackRow> fill_between_searches(std::span<const TrackRow> rows, std::span<const std::int32_t> searched,
                                            std::span<const Timestamp> times);

}  // namespace marey::track::offline
