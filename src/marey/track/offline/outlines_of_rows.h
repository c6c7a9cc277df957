#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>

#include "marey/core/track.h"
#include "marey/track/offline/outline_log.h"
#include "marey/track/offline/tracklet_log.h"

namespace marey::track::offline {

/// Gives the rows of a second pass the outlines of the first. A row that was seen keeps the outline of that frame, its centre
/// smoothed; one that was filled in gets the last outline of the same target, moved and scaled with it, and `held`. Curves that
/// were found stay where they were found; those that were held go with the smoothed centre.
class OutlinesOfRows {
 public:
  /// The recording must outlive it.
  explicit OutlinesOfRows(OutlineLog& recording) : recording_(recording) {}

  /// `rows` are those of `frame`, and `tracks` the same as tracks, in the same order. Frames grow from call to call.
  void attach(std::int64_t frame, std::span<const TrackRow> rows, std::span<Track<2>> tracks);

 private:
  struct Last {
    std::shared_ptr<const Outline> outline;
    Vector<2> location;  // of the row it was seen in
    double height = 0;   // of its box
  };

  OutlineLog& recording_;
  std::map<std::int32_t, Last> last_, before_;  // by id; of those in the frame, and in the one before
};

}  // namespace marey::track::offline
