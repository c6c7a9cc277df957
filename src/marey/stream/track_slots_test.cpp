#include "marey/stream/track_slots.h"

#include <gtest/gtest.h>

namespace marey::stream {
namespace {

/// The tracks in the slots after an instant with these tracks; 0 for an empty slot.
std::vector<int> slots_after(TrackSlots& slots, const std::vector<int>& tracks) {
  std::vector<Sample> samples;
  for (const int track : tracks) samples.emplace_back().track = TrackId{track};
  std::vector<const Sample*> pointers;
  for (const Sample& sample : samples) pointers.push_back(&sample);
  std::vector<int> found;
  for (const Sample* sample : slots.location(pointers)) found.push_back(sample == nullptr ? 0 : number(sample->track));
  return found;
}

TEST(TrackSlots, KeepsATrackInItsSlot) {
  TrackSlots slots(3);
  EXPECT_EQ(slots_after(slots, {7, 9}), (std::vector{7, 9, 0}));
  EXPECT_EQ(slots_after(slots, {9}), (std::vector{0, 9, 0}));
  EXPECT_EQ(slots_after(slots, {9, 7}), (std::vector{7, 9, 0}));
}

TEST(TrackSlots, ReusesTheSlotOfTheTrackLostFirst) {
  TrackSlots slots(2);
  slots_after(slots, {1, 2});
  slots_after(slots, {2});
  slots_after(slots, {});
  EXPECT_EQ(slots_after(slots, {3}), (std::vector{3, 0}));
  EXPECT_EQ(slots_after(slots, {2, 3}), (std::vector{3, 2}));
}

TEST(TrackSlots, CountsSamplesWithoutSlot) {
  TrackSlots slots(2);
  EXPECT_EQ(slots_after(slots, {1, 2, 3}), (std::vector{1, 2}));
  EXPECT_EQ(slots.without_slot(), 1);
  TrackSlots none;
  EXPECT_TRUE(slots_after(none, {1}).empty());
}

}  // namespace
}  // namespace marey::stream
