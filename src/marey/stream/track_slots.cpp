#include "marey/stream/track_slots.h"

#include <algorithm>

namespace marey::stream {

const std::vector<const Sample*>& TrackSlots::location(const std::vector<const Sample*>& samples) {
  samples_.assign(slots_.size(), nullptr);
  ++instant_;
  const auto put = [&](std::size_t slot, const Sample& sample) {
    slots_[slot] = {sample.track, instant_};
    samples_[slot] = &sample;
  };
  std::vector<const Sample*> waiting;
  for (const Sample* sample : samples) {
    const auto own = std::find_if(slots_.begin(), slots_.end(), [&](const Slot& slot) { return slot.track == sample->track; });
    if (own != slots_.end())
      put(static_cast<std::size_t>(own - slots_.begin()), *sample);
    else
      waiting.push_back(sample);
  }
  for (const Sample* sample : waiting) {
    const auto longest =
        std::min_element(slots_.begin(), slots_.end(), [](const Slot& a, const Slot& b) { return a.last < b.last; });
    if (longest == slots_.end() || longest->last == instant_)
      ++without_slot_;
    else
      put(static_cast<std::size_t>(longest - slots_.begin()), *sample);
  }
  return samples_;
}

}  // namespace marey::stream
