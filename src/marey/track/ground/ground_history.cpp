#include "marey/track/ground/ground_history.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace marey::track::ground {

void GroundHistory::begin(Timestamp now) {
  if (spare_.empty()) {
    levels_.emplace_back();
  } else {
    levels_.push_back(std::move(spare_.back()));
    spare_.pop_back();
  }
  levels_.back().now = now;
}

int GroundHistory::claim(int look, int observation, int before) {
  levels_.back().claims.push_back({look, observation, before});
  return static_cast<int>(levels_.back().claims.size()) - 1;
}

GroundHistory::Place GroundHistory::note(const Place& before, const Track<2>& track, int claims) {
  Level& level = levels_.back();
  level.records.push_back({track, before.record, claims});
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

int GroundHistory::past(Place place, std::int64_t level) const {
  if (place.level < level) return nobody;
  for (; place.level > level && place.record != nobody; --place.level) place.record = at(place.level).records[place.record].before;
  return place.record;
}

void GroundHistory::decide(std::int64_t level, std::span<const Place> places) {
  const auto count = static_cast<std::size_t>(level - first_ + 1);
  chosen_.resize(std::max(chosen_.size(), count));
  for (std::size_t i = 0; i < count; ++i) chosen_[i].clear();
  for (Place place : places) {
    for (; place.level >= first_ && place.record != nobody; --place.level) {
      if (place.level <= level) chosen_[static_cast<std::size_t>(place.level - first_)].push_back(place.record);
      place.record = at(place.level).records[place.record].before;
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    Level& decided = levels_.front();
    for (const int index : chosen_[i]) {
      const Record& record = decided.records[index];
      told_tracks_.push_back(record.track);
      for (int c = record.claims; c != nobody; c = decided.claims[c].before) {
        told_claims_.push_back({record.track.id, decided.claims[c].look, decided.claims[c].observation});
      }
    }
    const Told before = told_.empty() ? Told{} : told_.back();
    std::sort(told_tracks_.begin() + static_cast<std::ptrdiff_t>(before.tracks), told_tracks_.end(),
              [](const Track<2>& a, const Track<2>& b) { return a.id < b.id; });
    std::sort(told_claims_.begin() + static_cast<std::ptrdiff_t>(before.claims), told_claims_.end(),
              [](const ObservationMatch& a, const ObservationMatch& b) {
                return std::tuple(a.look, a.observation) < std::tuple(b.look, b.observation);
              });
    told_.push_back({decided.now, told_tracks_.size(), told_claims_.size()});
    decided.records.clear();
    decided.claims.clear();
    spare_.push_back(std::move(decided));
    levels_.pop_front();
    ++first_;
  }
}

void GroundHistory::forget_told() {
  told_.clear();
  told_tracks_.clear();
  told_claims_.clear();
}

std::span<const GroundDecision> GroundHistory::told() {
  decisions_.clear();
  std::size_t tracks = 0;
  std::size_t claims = 0;
  for (const Told& one : told_) {
    decisions_.push_back({one.now, std::span(told_tracks_).subspan(tracks, one.tracks - tracks),
                          std::span(told_claims_).subspan(claims, one.claims - claims)});
    tracks = one.tracks;
    claims = one.claims;
  }
  return decisions_;
}

}  // namespace marey::track::ground
