#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "marey/core/time.h"
#include "marey/core/track.h"
#include "marey/track/ground/ground_tracker.h"

namespace marey::track::ground {

/// What is not decided yet of the past of many hypothetical targets: a level for each instant, and in it a record for each that was
/// thought of then, which points to its own past a level before. Whoever shares a past shares the records. Levels that are decided
/// are told and forgotten, so that memory is bounded by the window.
class GroundHistory {
 public:
  static constexpr int nobody = -1;

  /// A record. Levels count from the first instant on.
  struct Place {
    std::int64_t level = nobody;
    int record = nobody;
  };

  /// A new level, which records and claims go to.
  void begin(Timestamp now);

  /// Something seen at this instant, and what was seen before it of the same target at this instant, or nobody; returns its name.
  int claim(int look, int observation, int before);

  /// What is thought of one target now. `before` is its record a level before; `claims` its last claim, or nobody.
  Place note(const Place& before, const Track<2>& track, int claims);

  /// Calls visit(look, observation) for the claims of this instant that end in `claims`.
  template <typename Visit>
  void for_each_claim(int claims, Visit&& visit) const {
    for (int i = claims; i != nobody; i = levels_.back().claims[i].before) {
      visit(levels_.back().claims[i].look, levels_.back().claims[i].observation);
    }
  }

  /// Calls tell(key) for each observation that a target claimed before this level and after the levels forgotten: one key for each.
  template <typename Tell>
  void for_each_past_claim(Place place, Tell&& tell) const {
    for (; place.level >= first_ && place.record != nobody; --place.level) {
      const Level& level = at(place.level);
      const Record& record = level.records[place.record];
      for (int i = record.claims; i != nobody; i = level.claims[i].before) {
        tell((place.level << 32) + (static_cast<std::int64_t>(level.claims[i].look) << 20) + level.claims[i].observation);
      }
      place.record = record.before;
    }
  }

  /// The newest level that is not later than `until`; nothing where all such are forgotten.
  std::optional<std::int64_t> newest_until(Timestamp until) const;
  std::optional<std::int64_t> newest() const;

  /// The record at `level` of the target that is at `place` later; nobody where it began after it, or ended before.
  int past(Place place, std::int64_t level) const;

  /// Tells the levels up to `level`, as far as they are not forgotten, of the targets that are at `places`, and forgets them. What
  /// is told is added to that which was told since `forget_told`.
  void decide(std::int64_t level, std::span<const Place> places);
  void forget_told();

  /// Valid until anything is decided.
  std::span<const GroundDecision> told();

 private:
  struct Claim {
    int look = 0, observation = 0;
    int before = nobody;
  };
  struct Record {
    Track<2> track;
    int before = nobody;
    int claims = nobody;
  };
  struct Level {
    Timestamp now{};
    std::vector<Record> records;
    std::vector<Claim> claims;
  };
  struct Told {
    Timestamp now{};
    std::size_t tracks = 0, claims = 0;  // where they end
  };
  const Level& at(std::int64_t level) const { return levels_[static_cast<std::size_t>(level - first_)]; }

  std::deque<Level> levels_;
  std::vector<Level> spare_;
  std::int64_t first_ = 0;
  std::vector<Told> told_;
  std::vector<Track<2>> told_tracks_;
  std::vector<ObservationMatch> told_claims_;
  std::vector<GroundDecision> decisions_;
  std::vector<std::vector<int>> chosen_;  // of each level that is being decided: records
};

}  // namespace marey::track::ground
