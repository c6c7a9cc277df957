// What is trusted of each instant while a recording continues, from what a tracker says: a target is held back until it is
// confirmed, and an unobserved target is reported only as long as the odds are that the target is there, and there.
//
// How long a person who is not seen may still be trusted in is learned from the recording: each time a target is seen again, the
// gap says how long people stay unseen who have not left; each time one is given up, that it had left (or never was). The share of
// the gaps that lasted longer than one has lasted so far, among those and the farewells, is the probability that the target is
// still there: an estimate of survival by counts, with a prior of a few gaps. That it is where it is predicted is read off the
// filter's covariance: a box that is off by more than a third of its side overlaps the person by less than half.
//
// A `delay` is a lookahead: a target is distinguished from its first observation on if it is confirmed by then, gaps that
// close within it are filled from both sides, and the odds are those of the later instant. Cost: linear in the tracks; memory:
// those of `delay` seconds.
#pragma once

#include <array>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "marey/core/instant.h"
#include "marey/core/time.h"
#include "marey/core/track.h"

namespace marey::track::image {

/// How likely it is that a target which has not been seen for a while will be seen again, learned from the gaps of a recording.
class GapSurvival {
 public:
  /// A target was seen again after a gap, s.
  void found_again(double gap);
  /// A target was given up.
  void lost() { lost_ += 1; }
  /// That one which was seen `unseen` ≥ 0 seconds ago is still there.
  double still_there(double unobserved) const;

 private:
  static constexpr double kBin = 0.04;  // s
  std::array<double, 250> found_{};     // gaps by length
  double lost_ = 0;
};

class LiveTracks {
 public:
  /// `delay` ≥ 0 s.
  explicit LiveTracks(double delay) : delay_(delay) {}

  /// The tracker's tracks at one instant, unconfirmed ones included. `frames` go along.
  void add(std::int64_t index, Timestamp time, std::span<const Track<2>> tracks, std::vector<Frame> frames = {});
  /// The same of a frame in which no person was searched for: `tracks` are predicted, and say nothing of who is still there.
  void add_unsearched(std::int64_t index, Timestamp time, std::span<const Track<2>> tracks, std::vector<Frame> frames = {});
  /// The next instant that is `delay` old, or at the end of the recording, with `all`, any; nothing if there is no such instant.
  std::optional<Instant> next(bool all = false);
  /// Whether no instant waits to be reported.
  bool empty() const { return time_steps_.empty(); }

 private:
  struct TimeStep {
    std::int64_t index = 0;
    Timestamp time{};
    std::vector<Track<2>> tracks;
    std::vector<Frame> frames;
    bool searched = true;
  };
  /// A target as last seen.
  struct Detected {
    std::optional<Timestamp> time;   ///< of the last observation
    std::optional<Sample> reported;  ///< the last observation that was reported,
    Timestamp reported_time{};       ///< and its time
    bool confirmed = false;
  };

  std::optional<Sample> reported(const TimeStep& time_step, const Track<2>& track);
  std::optional<Sample> filled(const TimeStep& time_step, const Track<2>& track) const;
  void forget_lost(const TimeStep& reported);

  double delay_;
  std::optional<Timestamp> now_, searched_;  // of the last frame, and of the last one that was searched
  std::deque<TimeStep> time_steps_;
  std::map<TrackId, Detected> detected_;  // who is followed
  GapSurvival survival_;
};

}  // namespace marey::track::image
