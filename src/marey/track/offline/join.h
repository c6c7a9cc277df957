#pragma once

#include <optional>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/track/image/box_noise.h"
#include "marey/track/offline/returns.h"
#include "marey/track/offline/smooth.h"
#include "marey/track/offline/tracklet_log.h"

namespace marey::track::offline {

/// Lengths in body heights where targets have boxes, else in px.
struct JoinOptions {
  double longest_gap = 4;        ///< s; a person who reappears later is a new one
  double longest_filled = 2.5;   ///< s; a longer gap is joined, but nothing is said of where the target was in the meantime
  double position_noise = 0.12;  ///< standard deviation of an end of a tracklet
  double speed_noise = 0.35;     ///< by how much the mean speed in a gap differs from that at its ends, 1/s
  double size_noise = 0.15;      ///< of the logarithm of the height
  double shortest = 0.35;        ///< s; a tracklet seen for less is taken for a false alarm
  int min_detections = 3;        ///< observations; likewise
  double rarest = 0.35;          ///< share of its frames; one seen in fewer likewise
  double weaker = 0.15;          ///< what scores this much below the typical must last longer and be seen more often
  /// The image, px. One that ends at its border has left, one that begins there has come: they are joined on strong evidence alone.
  std::optional<Box> view = {};
  Smoothing smoothing = {};
  ReturnOptions returns = {};  ///< who left the image and came back; asked for only where `view` is known
};

/// What the second pass decided that is said of a recording.
struct JoinReport {
  std::vector<Returned> returned;  ///< who left the image and came back; indices of no use any more
};

/// The same for boxes whose noise was learned: paths are smoothed as far as their boxes need it, and people who accelerate harder
/// than walkers may have gone farther while they were not seen.
JoinOptions adapted(JoinOptions options, const image::BoxNoise& noise);

/// The second pass over a whole recording, which may use later frames. Tracklets that are one target's are joined, gaps filled with
/// predicted rows, ends without an observation cut, false alarms dropped, paths smoothed, ids given again from 1 in the order of
/// first appearance. Rows in the order of frames, then ids. The recording's tracklets are used up.
std::vector<TrackRow> join(TrackletLog& log, const JoinOptions& options = {}, JoinReport* report = nullptr);

}  // namespace marey::track::offline
