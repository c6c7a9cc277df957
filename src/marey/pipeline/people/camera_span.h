#pragma once

#include <map>
#include <span>

#include "marey/core/ids.h"
#include "marey/core/time.h"
#include "marey/core/track.h"

namespace marey::pipeline::people {

/// Whether a camera moves, judged by tracks in its image alone: all people go the same way at once, time and again. Where the
/// camera keeps up with people who go one way, nothing shows; where people stream past a camera that stands, it looks as if it
/// moved.
class CameraSpan {
 public:
  /// The tracks of one frame; those that are confirmed and observed count.
  void see(Timestamp now, std::span<const Track<2>> tracks);

  bool moved() const;
  /// By how much the image moved from one second to the next at most, px.
  double farthest() const { return farthest_; }

 private:
  struct Place {
    Vector<2> place = Vector<2>::Zero();
    double height = 1;
  };
  void compare(const std::map<TrackId, Place>& now);

  std::map<TrackId, Place> before_;
  Timestamp taken_{};
  double farthest_ = 0;
  double coherence_ = 0;  // sum over `seconds_`
  int seconds_ = 0;
};

}  // namespace marey::pipeline::people
