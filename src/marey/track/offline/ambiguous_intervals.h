// Where a tracklet may have gone on as another person: cut there, so that the second pass can decide it again, knowing what came
// after.
//
// A tracklet is uncertain while its box and another's overlap, while another begins or ends close by (of two who meet, one is often
// lost and found again), and while it is not seen. Doubts of tracklets that touch each other are one meeting. What lies between two
// doubts is a piece; a piece's rows within a doubt are kept, marked, and say nothing of where it was going or what it wore.
// Cost: rows · log, and the pairs of boxes that overlap.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "marey/track/offline/tracklet_log.h"

namespace marey::track::offline {

struct AmbiguityOptions {
  double overlap = 0.35;    ///< share of the smaller box that the other's covers, from which on two may be taken for each other
  double close = 0.3;       ///< heights round the box of one that begins or ends, within which another may be the same person
  double before = 0.5;      ///< s before such an event, and
  double after = 1;         ///< s after it, that another counts as close by
  double unobserved = 0.4;  ///< s not seen, from which on it is uncertain
  double parted = 0.4;      ///< s; doubts that follow each other sooner are one
};

/// A part of a tracklet between two doubts.
struct TrackletPart {
  int tracklet = 0;                   ///< of which it is a part; a tracklet's parts follow one another
  int first = 0, end = 0;             ///< its rows, without `end`
  std::optional<int> head_encounter;  ///< out of which it comes
  std::optional<int> tail_encounter;  ///< into which it goes
};

/// All parts, in the order of the tracklets and of time; every row is in one. Rows uncertain are marked so, all others not.
std::vector<TrackletPart> find_parts_between_ambiguities(std::span<TrackletLog::Tracklet> tracklets, const TrackletLog& log,
                                                         const AmbiguityOptions& options = {});

/// The same with rows of its own.
struct TrackletPiece {
  TrackletLog::Tracklet rows;
  int tracklet = 0;
  std::optional<int> head_encounter, tail_encounter;
};

/// All parts as pieces. The rows are never held twice, but for one tracklet's: in a match of 90 minutes they are a hundred
/// megabytes.
std::vector<TrackletPiece> cut_where_in_ambiguity(std::vector<TrackletLog::Tracklet> tracklets, const TrackletLog& log,
                                                  const AmbiguityOptions& options = {});

}  // namespace marey::track::offline
