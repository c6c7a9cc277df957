// Which of a fixed number of slots an unlabelled track has: streams whose channels are fixed (LSL) send such tracks by slot. A
// track keeps its slot while it is there and returns to it until another track needs it; a new track takes an unused slot, else the
// one whose track was lost first. Cost: one pass over slots and samples per instant.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "marey/core/instant.h"

namespace marey::stream {

class TrackSlots {
 public:
  explicit TrackSlots(std::size_t count = 0) : slots_(count) {}

  /// One per slot: its track's sample at this instant, null if it has no sample. Valid as long as `samples`.
  const std::vector<const Sample*>& location(const std::vector<const Sample*>& samples);

  std::size_t size() const { return slots_.size(); }
  /// Samples that had no slot, over all instants.
  std::int64_t without_slot() const { return without_slot_; }

 private:
  struct Slot {
    std::optional<TrackId> track;
    std::int64_t last = -1;  ///< instant at which its track was there last; -1: never used
  };

  std::vector<Slot> slots_;
  std::vector<const Sample*> samples_;
  std::int64_t instant_ = 0, without_slot_ = 0;
};

}  // namespace marey::stream
