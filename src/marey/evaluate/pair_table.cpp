#include "marey/evaluate/pair_table.h"

#include <algorithm>

namespace marey::evaluate {

IdPair& PairTable::at(int object, int track) {
  std::vector<Slot>& slots = by_object_[object];
  const auto slot = std::lower_bound(slots.begin(), slots.end(), track, [](const Slot& a, int b) { return a.track < b; });
  if (slot != slots.end() && slot->track == track) return pairs_[slot->pair];
  slots.insert(slot, {track, pairs_.size()});
  pairs_.push_back({.object = object, .track = track});
  return pairs_.back();
}

}  // namespace marey::evaluate
