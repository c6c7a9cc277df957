#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "marey/assign/no_index.h"
#include "marey/core/time.h"
#include "marey/core/track.h"
#include "marey/track/ground/ground_tracker.h"

namespace marey::track::ground::mht {

/// What is not decided yet of the past of many hypothetical targets: a level for each instant, and in it a record for each that was
/// thought of then, which points to its own past a level before. Targets that share a past share the records. Levels that are
/// decided are given out and forgotten, so that memory is bounded by the window.
class GroundHistory {
 public:
  /// A record. Levels count from the first instant on.
  struct Location {
    std::int64_t level = assign::kNoIndex;
    int record = assign::kNoIndex;
  };

  /// A new level, which records and matches go to.
  void begin(Timestamp now);

  /// An observation of this instant, and the match before it of the same target at this instant, or none; returns its index.
  int match(int view, int observation, int before);

  /// What is thought of one target now. `before` is its record a level before; `matches` its last match, or none.
  Location note(const Location& before, const Track<2>& track, int matches);

  /// Calls visit(view, observation) for the matches of this instant that end in `matches`.
  template <typename Visit>
  void for_each_match(int matches, Visit&& visit) const {
    for (int i = matches; i != assign::kNoIndex; i = levels_.back().matches[i].before) {
      visit(levels_.back().matches[i].view, levels_.back().matches[i].observation);
    }
  }

  /// Calls visit(key) for each observation that a target matched before this level and after the levels forgotten: one key for
  /// each.
  template <typename Visit>
  void for_each_past_match(Location location, Visit&& visit) const {
    for (; location.level >= first_ && location.record != assign::kNoIndex; --location.level) {
      const Level& level = at(location.level);
      const Record& record = level.records[location.record];
      for (int i = record.matches; i != assign::kNoIndex; i = level.matches[i].before) {
        visit((location.level << 32) + (static_cast<std::int64_t>(level.matches[i].view) << 20) + level.matches[i].observation);
      }
      location.record = record.before;
    }
  }

  /// The newest level that is not later than `until`; nothing if all such are forgotten.
  std::optional<std::int64_t> newest_until(Timestamp until) const;
  std::optional<std::int64_t> newest() const;

  /// The record at `level` of the target that is at `place` later; none where it began after it, or ended before.
  int past(Location location, std::int64_t level) const;

  /// Decides the levels up to `level`, as far as they are not forgotten, of the targets that are at `places`, and forgets them.
  /// What is decided is added to that which was since `forget_decided`.
  void decide(std::int64_t level, std::span<const Location> locations);
  void forget_decided();

  /// Valid until anything is decided.
  std::span<const GroundDecision> decided();

 private:
  struct Match {
    int view = 0, observation = 0;
    int before = assign::kNoIndex;
  };
  struct Record {
    Track<2> track;
    int before = assign::kNoIndex;
    int matches = assign::kNoIndex;
  };
  struct Level {
    Timestamp now{};
    std::vector<Record> records;
    std::vector<Match> matches;
  };
  struct Decided {
    Timestamp now{};
    std::size_t tracks = 0, matches = 0;  // where they end
  };
  const Level& at(std::int64_t level) const { return levels_[static_cast<std::size_t>(level - first_)]; }

  std::deque<Level> levels_;
  std::vector<Level> spare_;
  std::int64_t first_ = 0;
  std::vector<Decided> decided_;
  std::vector<Track<2>> decided_tracks_;
  std::vector<ObservationMatch> decided_matches_;
  std::vector<GroundDecision> decisions_;
  std::vector<std::vector<int>> chosen_;  // of each level that is being decided: records
};

}  // namespace marey::track::ground::mht
