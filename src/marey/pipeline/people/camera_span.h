#pragma once

#include <map>
#include <span>

#include "marey/core/ids.h"
#include "marey/core/time.h"
#include "marey/core/track.h"

namespace marey::pipeline::people {

/// Whether a camera moves, evaluated by tracks in its image alone: all people go likewise at once, time and again. Where the
/// camera keeps up with people who move as one, nothing shows; where people stream past a static camera, it appears as if it
/// moved.
class CameraSpan {
 public:
  /// The tracks of one frame; those that are confirmed and observed count.
  void observe_frame(Timestamp now, std::span<const Track<2>> tracks);

  bool moved() const;
  /// By how much the image moved from one second to the next at most, px.
  double farthest() const { return farthest_; }

 private:
  struct Location {
    Vector<2> location = Vector<2>::Zero();
    double height = 1;
  };
  void compare(const std::map<TrackId, Location>& now);

  std::map<TrackId, Location> before_;
  Timestamp taken_{};
  double farthest_ = 0;
  double coherence_ = 0;  // sum over `seconds_`
  int seconds_ = 0;
};

}  // namespace marey::pipeline::people
