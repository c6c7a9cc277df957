#include "marey/track/ground/offline/ground_swaps.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

namespace marey::track::ground::offline {
namespace {

constexpr std::size_t kMaxKindsTried = 60;  // of colours; numerical: more only costs time

class Swapper {
 public:
  Swapper(std::vector<GroundTracklet>& tracklets, std::span<const Timestamp> times, const SwapRepairOptions& options)
      : tracklets_(tracklets),
        times_(times),
        options_(options),
        colours_(kinds(tracklets, times, options.teams)),
        holder_(tracklets.size()) {
    std::iota(holder_.begin(), holder_.end(), 0);
  }

  /// Whether the two were exchanged.
  bool settle(const CloseEncounter& encounter) {
    const int a = holder_[encounter.a];
    const int b = holder_[encounter.b];
    const auto gain = gain_of_swap(samples_of(a), samples_of(b), encounter, times_, colours_, options_);
    if (!gain || *gain < options_.certainly) return false;
    swap_later_parts(a, b, encounter.nearest);
    std::swap(holder_[encounter.a], holder_[encounter.b]);
    return true;
  }

 private:
  static GroundColours kinds(const std::vector<GroundTracklet>& tracklets, std::span<const Timestamp> times,
                             const std::optional<GroundTeams>& teams) {
    std::vector<GroundColours::Detected> detected;
    for (const GroundTracklet& tracklet : tracklets) {
      const auto clothing = appearance_of(tracklet.samples);
      if (!clothing) continue;
      detected.push_back({*clothing, seconds(times[tracklet.samples.back().instant] - times[tracklet.samples.front().instant])});
    }
    std::stable_sort(detected.begin(), detected.end(),
                     [](const GroundColours::Detected& a, const GroundColours::Detected& b) { return a.seconds > b.seconds; });
    if (detected.size() > kMaxKindsTried) detected.resize(kMaxKindsTried);
    return GroundColours(detected, teams);
  }

  std::span<const GroundSample> samples_of(int tracklet) const { return tracklets_[tracklet].samples; }

  void swap_later_parts(int a, int b, std::int32_t instant) {
    GroundTracklet later_a = split(tracklets_[a], index_from(tracklets_[a].samples, instant));
    GroundTracklet later_b = split(tracklets_[b], index_from(tracklets_[b].samples, instant));
    append(tracklets_[a], later_b);
    append(tracklets_[b], later_a);
  }

  std::vector<GroundTracklet>& tracklets_;
  std::span<const Timestamp> times_;
  const SwapRepairOptions& options_;
  GroundColours colours_;
  std::vector<int> holder_;  // where a recorded tracklet continues now
};

}  // namespace

int repair_swaps(std::vector<GroundTracklet>& tracklets, std::span<const Timestamp> times, const SwapRepairOptions& options) {
  Swapper swapper(tracklets, times, options);
  int swapped = 0;
  for (const CloseEncounter& encounter : find_encounters(tracklets, times, options.near))
    swapped += swapper.settle(encounter) ? 1 : 0;
  return swapped;
}

}  // namespace marey::track::ground::offline
