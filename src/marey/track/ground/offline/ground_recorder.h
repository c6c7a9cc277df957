#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "marey/core/appearance.h"
#include "marey/core/recording.h"
#include "marey/core/time.h"
#include "marey/core/track.h"
#include "marey/track/ground/ground_tracker.h"
#include "marey/track/ground/offline/ground_join.h"
#include "marey/track/ground/offline/ground_tracklet.h"

namespace marey::track::ground::offline {

/// Lengths in m, times in s.
struct GroundJoinOptions {
  double longest_gap = 20;     ///< who reappears later is a person new
  double longest_filled = 5;   ///< a longer gap is joined, but nothing is said of where the person was in the meantime
  double longest_begun = 0.5;  ///< who is seen from a camera's own first instant on is reported before that, for this long at most
  double shortest = 0.5;       ///< who is seen for less is taken for a false alarm
  double rarest = 0.4;         ///< who is seen in a smaller share of the instants between first and last likewise
  double max_speed = 12;       ///< m/s; no person runs faster
  GroundMotion motion;         ///< how people move
  std::optional<GroundTeams> teams = {};  ///< what two teams wear, where that is known
};

/// Observations of people on the ground, instant by instant, kept for a second pass that may use later frames: 48 bytes a person
/// and instant. Tracks that are never confirmed are forgotten as they end.
class GroundRecorder {
 public:
  /// One instant: the tracks, views and matches of one GroundTracker::step. Frames grow from call to call; some may be missing.
  void add(std::int32_t frame, Timestamp time, std::span<const Track<2>> tracks, std::span<const CameraObservations> views,
           std::span<const ObservationMatch> matches);

  /// Between frames `first` and `last`, both included, what the tracker called `track` was `person`.
  struct Piece {
    TrackId track{};
    std::int32_t first = 0, last = 0;
    TrackId person{};  ///< its track in the recording
  };
  /// After frame `before` it was not followed until frame `after`, from which on another track of the tracker's is taken for it.
  struct Join {
    TrackId person{};
    std::int32_t before = 0, after = 0;
    double probability = 0;  ///< that both are the same person
  };
  struct Joined {
    marey::Recording recording;  ///< a track a person, smoothed, on the world's ground; every frame that was added is an instant
    std::vector<Piece> pieces;   ///< by track, then by frame; what is in none was a false alarm
    std::vector<Join> joins;     ///< by person, then by frame
    std::vector<std::optional<Appearance>> clothing;  ///< of each of its tracks: the median over all that was seen of it

    /// Who it was that the tracker called `track` in `frame`.
    std::optional<TrackId> person_of(TrackId track, std::int32_t frame) const;
  };

  /// Joins what is one person's (by place, speed and what they wear), drops false alarms, fills gaps, smooths. Ids are given again
  /// from 1 in the order of first appearance. `in_sight` gives where people are seen and reported: at its border they are likely to
  /// come and go; without it, nowhere. Used up afterwards.
  Joined join(const GroundJoinOptions& options = {}, const InSight& in_sight = {}) &&;

  /// What was confirmed so far, by track, to learn from; used up afterwards.
  std::vector<GroundTracklet> tracklets() &&;
  std::span<const Timestamp> times() const { return times_; }

 private:
  std::vector<Timestamp> times_;
  std::vector<std::int32_t> frames_;
  std::vector<std::int32_t> camera_begins_;  // the first instant of each camera
  std::vector<GroundTracklet> open_;         // by id
  std::vector<GroundTracklet> closed_;
};

}  // namespace marey::track::ground::offline
