#pragma once

#include <optional>
#include <span>
#include <vector>

#include "marey/track/tracker.h"

namespace marey::track {

/// What trackers share that decide each instant at once.
template <int D>
class ImmediateTracker : public Tracker<D> {
 public:
  using Tracker<D>::step;

  std::span<const ObservationMatch> matches() const final { return matches_; }

  std::span<const Decision<D>> decided() final {
    if (!now_) return {};
    decision_ = {*now_, tracks_, matches_};
    return {&decision_, 1};
  }

  std::span<const Decision<D>> decide_all() final { return {}; }

 protected:
  /// Seconds from the last instant to `now`; 0 before the first.
  double seconds_to(Timestamp now) const { return now_ ? seconds(now - *now_) : 0.0; }

  /// Each track's own observation, of the only view.
  void match_by_observation() {
    matches_.clear();
    for (const Track<D>& track : tracks_) {
      if (track.observation) matches_.push_back({track.id, 0, *track.observation});
    }
  }

  std::optional<Timestamp> now_;  // of the last instant
  std::vector<Track<D>> tracks_;
  std::vector<ObservationMatch> matches_;

 private:
  Decision<D> decision_;
};

}  // namespace marey::track
