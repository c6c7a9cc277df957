#include "marey/track/ground/offline/ground_swaps.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

namespace marey::track::ground::offline {
namespace {

constexpr std::size_t kMostKindsTried = 60;  // of colours; more only costs time

class Exchanger {
 public:
  Exchanger(std::vector<GroundTracklet>& tracklets, std::span<const Timestamp> times, const SwapRepairOptions& options)
      : tracklets_(tracklets),
        times_(times),
        options_(options),
        colours_(kinds(tracklets, times, options.teams)),
        holder_(tracklets.size()) {
    std::iota(holder_.begin(), holder_.end(), 0);
  }

  /// Whether the two were exchanged.
  bool settle(const GroundMeeting& meeting) {
    const int a = holder_[meeting.a];
    const int b = holder_[meeting.b];
    const auto gain = gain_of_exchange(samples_of(a), samples_of(b), meeting, times_, colours_, options_);
    if (!gain || *gain < options_.surely) return false;
    exchange(a, b, meeting.nearest);
    std::swap(holder_[meeting.a], holder_[meeting.b]);
    return true;
  }

 private:
  static GroundColours kinds(const std::vector<GroundTracklet>& tracklets, std::span<const Timestamp> times,
                             const std::optional<GroundTeams>& teams) {
    std::vector<GroundColours::Seen> seen;
    for (const GroundTracklet& tracklet : tracklets) {
      const auto wears = appearance_of(tracklet.samples);
      if (!wears) continue;
      seen.push_back({*wears, seconds(times[tracklet.samples.back().instant] - times[tracklet.samples.front().instant])});
    }
    std::stable_sort(seen.begin(), seen.end(),
                     [](const GroundColours::Seen& a, const GroundColours::Seen& b) { return a.seconds > b.seconds; });
    if (seen.size() > kMostKindsTried) seen.resize(kMostKindsTried);
    return GroundColours(seen, teams);
  }

  std::span<const GroundSample> samples_of(int tracklet) const { return tracklets_[tracklet].samples; }

  void exchange(int a, int b, std::int32_t instant) {
    GroundTracklet later_a = split(tracklets_[a], index_from(tracklets_[a].samples, instant));
    GroundTracklet later_b = split(tracklets_[b], index_from(tracklets_[b].samples, instant));
    append(tracklets_[a], later_b);
    append(tracklets_[b], later_a);
  }

  std::vector<GroundTracklet>& tracklets_;
  std::span<const Timestamp> times_;
  const SwapRepairOptions& options_;
  GroundColours colours_;
  std::vector<int> holder_;  // where what was recorded as a tracklet goes on now
};

}  // namespace

int repair_swaps(std::vector<GroundTracklet>& tracklets, std::span<const Timestamp> times, const SwapRepairOptions& options) {
  Exchanger exchanger(tracklets, times, options);
  int exchanged = 0;
  for (const GroundMeeting& meeting : find_meetings(tracklets, times, options.near)) exchanged += exchanger.settle(meeting) ? 1 : 0;
  return exchanged;
}

}  // namespace marey::track::ground::offline
