#include "marey/track/ground/mht/ground_history.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace marey::track::ground::mht {

void GroundHistory::begin(Timestamp now) {
  if (spare_.empty()) {
    levels_.emplace_back();
  } else {
    levels_.push_back(std::move(spare_.back()));
    spare_.pop_back();
  }
  levels_.back().now = now;
}

int GroundHistory::match(int view, int observation, int before) {
  levels_.back().matches.push_back({view, observation, before});
  return static_cast<int>(levels_.back().matches.size()) - 1;
}

GroundHistory::Location GroundHistory::note(const Location& before, const Track<2>& track, int matches) {
  Level& level = levels_.back();
  level.records.push_back({track, before.record, matches});
  return {first_ + static_cast<std::int64_t>(levels_.size()) - 1, static_cast<int>(level.records.size()) - 1};
}

std::optional<std::int64_t> GroundHistory::newest_until(Timestamp until) const {
  std::int64_t level = first_ + static_cast<std::int64_t>(levels_.size()) - 1;
  while (level >= first_ && at(level).now > until) --level;
  return level >= first_ ? std::optional(level) : std::nullopt;
}

std::optional<std::int64_t> GroundHistory::newest() const {
  if (levels_.empty()) return std::nullopt;
  return first_ + static_cast<std::int64_t>(levels_.size()) - 1;
}

int GroundHistory::past(Location location, std::int64_t level) const {
  if (location.level < level) return assign::kNoIndex;
  for (; location.level > level && location.record != assign::kNoIndex; --location.level)
    location.record = at(location.level).records[location.record].before;
  return location.record;
}

void GroundHistory::decide(std::int64_t level, std::span<const Location> locations) {
  const auto count = static_cast<std::size_t>(level - first_ + 1);
  chosen_.resize(std::max(chosen_.size(), count));
  for (std::size_t i = 0; i < count; ++i) chosen_[i].clear();
  for (Location location : locations) {
    for (; location.level >= first_ && location.record != assign::kNoIndex; --location.level) {
      if (location.level <= level) chosen_[static_cast<std::size_t>(location.level - first_)].push_back(location.record);
      location.record = at(location.level).records[location.record].before;
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    Level& decided = levels_.front();
    for (const int index : chosen_[i]) {
      const Record& record = decided.records[index];
      decided_tracks_.push_back(record.track);
      for (int c = record.matches; c != assign::kNoIndex; c = decided.matches[c].before) {
        decided_matches_.push_back({record.track.id, decided.matches[c].view, decided.matches[c].observation});
      }
    }
    const Decided before = decided_.empty() ? Decided{} : decided_.back();
    std::sort(decided_tracks_.begin() + static_cast<std::ptrdiff_t>(before.tracks), decided_tracks_.end(),
              [](const Track<2>& a, const Track<2>& b) { return a.id < b.id; });
    std::sort(decided_matches_.begin() + static_cast<std::ptrdiff_t>(before.matches), decided_matches_.end(),
              [](const ObservationMatch& a, const ObservationMatch& b) {
                return std::tuple(a.view, a.observation) < std::tuple(b.view, b.observation);
              });
    decided_.push_back({decided.now, decided_tracks_.size(), decided_matches_.size()});
    decided.records.clear();
    decided.matches.clear();
    spare_.push_back(std::move(decided));
    levels_.pop_front();
    ++first_;
  }
}

void GroundHistory::forget_decided() {
  decided_.clear();
  decided_tracks_.clear();
  decided_matches_.clear();
}

std::span<const GroundDecision> GroundHistory::decided() {
  decisions_.clear();
  std::size_t tracks = 0;
  std::size_t matches = 0;
  for (const Decided& one : decided_) {
    decisions_.push_back({one.now, std::span(decided_tracks_).subspan(tracks, one.tracks - tracks),
                          std::span(decided_matches_).subspan(matches, one.matches - matches)});
    tracks = one.tracks;
    matches = one.matches;
  }
  return decisions_;
}

}  // namespace marey::track::ground::mht
