// Where a tracklet may have gone on as another person: cut there, so that the second pass can decide it anew, knowing what came
// after.
//
// A tracklet is in doubt while its box and another's overlap, while another begins or ends close by (of two who meet, one is often
// lost and found again), and while it is not seen. Doubts of tracklets that touch each other are one meeting. What lies between two
// doubts is a piece; a piece's rows within a doubt are kept, marked, and say nothing of where it was going or what it wore.
// Cost: rows · log, and the pairs of boxes that overlap.
#pragma once

#include <optional>
#include <vector>

#include "marey/track/tracklet_log.h"

namespace marey::track {

struct DoubtOptions {
  double overlap = 0.35;  ///< share of the smaller box that the other's covers, from which on two may be taken for each other
  double close = 0.3;     ///< heights round the box of one that begins or ends, within which another may be the same person
  double before = 0.5;    ///< s before such an event, and
  double after = 1;       ///< s after it, that another counts as close by
  double unseen = 0.4;    ///< s not seen, from which on it is in doubt
  double parted = 0.4;    ///< s; doubts that follow each other sooner are one
};

/// A part of a tracklet between two doubts.
struct TrackletPiece {
  TrackletLog::Tracklet rows;
  int tracklet = 0;                 ///< of which it is a part; a tracklet's pieces follow one another
  std::optional<int> head_meeting;  ///< out of which it comes
  std::optional<int> tail_meeting;  ///< into which it goes
};

/// All pieces, in the order of the tracklets and of time. Rows in doubt are marked so, all others not.
std::vector<TrackletPiece> cut_where_in_doubt(std::vector<TrackletLog::Tracklet> tracklets, const TrackletLog& log,
                                              const DoubtOptions& options = {});

}  // namespace marey::track
