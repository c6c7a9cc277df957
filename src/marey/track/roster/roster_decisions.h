// What the roster tracker said of the last seconds, held back until names are sure: a marker that came back under a new name, and
// whose distances to its neighbours then prove that it is an old one, has the old name from its return on.
// Cost: targets × frames held, for each name that is corrected.
#pragma once

#include <deque>
#include <span>
#include <vector>

#include "marey/track/tracker.h"

namespace marey::track::roster {

/// From `since` on, what was called `from` is `to`'s. Where both are the same, it has proved to be a target since then.
struct RenamedTrack {
  TrackId from{}, to{};
  Timestamp since{};
};

/// D = 2 or 3.
template <int D>
class RosterDecisions {
 public:
  /// Frames are decided this long after they were seen, s.
  explicit RosterDecisions(double after) : after_(after) {}

  /// Takes in the newest frame, later than all before.
  void add(Timestamp now, std::span<const Track<D>> tracks);
  /// Names that are known better now, in the order in which that was found: what frames of that time say is changed.
  void rename(std::span<const RenamedTrack> renamed);

  /// The frames that are decided by now, each once, in order; with `all`, those that are left too. Valid until the next call.
  std::span<const Decision<D>> take(bool all);

 private:
  struct Held {
    Timestamp now{};
    std::vector<Track<D>> tracks;
    std::vector<ObservationMatch> matches;
  };

  static void rename(Held& frame, const RenamedTrack& renamed);

  double after_;
  std::deque<Held> held_;
  std::vector<Held> taken_;
  std::vector<Decision<D>> decisions_;
};

extern template class RosterDecisions<2>;
extern template class RosterDecisions<3>;

}  // namespace marey::track::roster
