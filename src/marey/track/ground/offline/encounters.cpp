#include "marey/track/ground/offline/encounters.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

namespace marey::track::ground::offline {
namespace {

constexpr double min_seconds = 0.3;                                   // of each one before and after: else nothing can be evaluated
constexpr double apart = 0.4;                                         // s: a person who comes near again sooner has not parted
constexpr double colour_seconds = 10;                                 // before and after, over which clothes are inspected
constexpr EndpointError in_the_open{.location = 0.25, .speed = 0.6};  // before and after a meeting people are in full view

bool together(const GroundSample& a, const GroundSample& b, double near) {
  const double unsure = 2 * (a.spread().trace() + b.spread().trace());
  return (a.at() - b.at()).squaredNorm() < near * near + unsure;
}

/// All meetings, in the order in which they begin.
class EncounterDetector {
 public:
  EncounterDetector(std::span<const GroundTracklet> tracklets, std::span<const Timestamp> times, double near)
      : tracklets_(tracklets), times_(times), near_(near) {}

  std::vector<CloseEncounter> close_encounters() {
    std::vector<int> by_start(tracklets_.size());
    std::iota(by_start.begin(), by_start.end(), 0);
    const auto start = [&](int i) { return tracklets_[i].samples.front().instant; };
    std::stable_sort(by_start.begin(), by_start.end(), [&](int a, int b) { return start(a) < start(b); });
    std::size_t begun = 0;
    for (std::int32_t now = 0; begun < by_start.size() || !present_.empty(); ++now) {
      for (; begun < by_start.size() && start(by_start[begun]) == now; ++begun) present_.push_back({by_start[begun], 0});
      inspect(now);
    }
    for (auto& [pair, close_encounter] : open_) found_.push_back(close_encounter);
    std::sort(found_.begin(), found_.end(), [](const CloseEncounter& x, const CloseEncounter& y) {
      return std::tie(x.nearest, x.a, x.b) < std::tie(y.nearest, y.a, y.b);
    });
    return std::move(found_);
  }

 private:
  struct Present {
    int tracklet = 0;
    std::size_t next = 0;  // sample
  };

  void inspect(std::int32_t now) {
    detected_.clear();
    for (Present& one : present_) {
      const std::vector<GroundSample>& samples = tracklets_[one.tracklet].samples;
      if (samples[one.next].instant == now) detected_.push_back({one.tracklet, one.next++});
    }
    std::erase_if(present_, [&](const Present& one) { return one.next == tracklets_[one.tracklet].samples.size(); });
    for (std::size_t i = 0; i < detected_.size(); ++i) {
      for (std::size_t j = i + 1; j < detected_.size(); ++j) compare(detected_[i], detected_[j], now);
    }
  }

  void compare(const Present& one, const Present& other, std::int32_t now) {
    const auto [x, y] = std::minmax(one, other, [](const Present& p, const Present& q) { return p.tracklet < q.tracklet; });
    const GroundSample& a = tracklets_[x.tracklet].samples[x.next];
    const GroundSample& b = tracklets_[y.tracklet].samples[y.next];
    const std::pair key(x.tracklet, y.tracklet);
    if (!together(a, b, near_)) {
      const auto open = open_.empty() ? open_.end() : open_.find(key);
      if (open == open_.end() || times_[now] - times_[open->second.last] < duration_from_seconds(apart)) return;
      found_.push_back(open->second);
      open_.erase(open);
      return;
    }
    CloseEncounter& close_encounter = open_.try_emplace(key, CloseEncounter{x.tracklet, y.tracklet, now, now, now}).first->second;
    close_encounter.last = now;
    const double distance = (a.at() - b.at()).squaredNorm();
    if (distance >= close_encounter.distance) return;
    close_encounter.distance = distance;
    close_encounter.nearest = now;
  }

  std::span<const GroundTracklet> tracklets_;
  std::span<const Timestamp> times_;
  double near_;
  std::vector<Present> present_, detected_;  // `next` of who is seen is the sample of now
  std::map<std::pair<int, int>, CloseEncounter> open_;
  std::vector<CloseEncounter> found_;
};

/// What lies before and after a meeting.
class Parting {
 public:
  Parting(const CloseEncounter& close_encounter, std::span<const Timestamp> times, const GroundColours& colours,
          const CloseEncounterOptions& options)
      : close_encounter_(close_encounter), times_(times), colours_(colours), options_(options) {}

  std::optional<double> gain_of_swap(std::span<const GroundSample> a, std::span<const GroundSample> b) const {
    const auto before_a = before(a), before_b = before(b);
    const auto after_a = after(a), after_b = after(b);
    if (!before_a || !before_b || !after_a || !after_b) return std::nullopt;
    if (too_fast(*before_a, *after_b) || too_fast(*before_b, *after_a)) return std::nullopt;
    return fits(*before_a, *after_b) + fits(*before_b, *after_a) - fits(*before_a, *after_a) - fits(*before_b, *after_b);
  }

 private:
  double lasting(std::span<const GroundSample> samples) const {
    return samples.empty() ? 0 : seconds(times_[samples.back().instant] - times_[samples.front().instant]);
  }

  std::optional<GroundEnd> before(std::span<const GroundSample> all) const {
    const auto samples = all.first(index_from(all, close_encounter_.first));
    if (lasting(samples) < min_seconds) return std::nullopt;
    GroundEnd end{.time = times_[samples.back().instant],
                  .state = last_state(samples, times_, options_.motion, options_.evaluated_by)};
    end.appearance = appearance_of(samples.subspan(index_at(samples, end.time - duration_from_seconds(colour_seconds))));
    return end;
  }

  std::optional<GroundEnd> after(std::span<const GroundSample> all) const {
    const auto samples = all.subspan(index_from(all, close_encounter_.last + 1));
    if (lasting(samples) < min_seconds) return std::nullopt;
    GroundEnd end{.time = times_[samples.front().instant],
                  .state = first_state(samples, times_, options_.motion, options_.evaluated_by)};
    end.appearance = appearance_of(samples.first(index_at(samples, end.time + duration_from_seconds(colour_seconds))));
    return end;
  }

  /// The first sample of this time or later.
  std::size_t index_at(std::span<const GroundSample> samples, Timestamp time) const {
    const auto earlier = [&](const GroundSample& sample) { return times_[sample.instant] < time; };
    return static_cast<std::size_t>(std::partition_point(samples.begin(), samples.end(), earlier) - samples.begin());
  }

  double fits(const GroundEnd& tail, const GroundEnd& head) const {
    return log_continuity(tail, head, colours_, options_.motion, in_the_open);
  }

  bool too_fast(const GroundEnd& tail, const GroundEnd& head) const {
    const double distance = (head.state.location() - tail.state.location()).norm();
    return distance > options_.max_speed * seconds(head.time - tail.time) + options_.near;
  }

  const CloseEncounter& close_encounter_;
  std::span<const Timestamp> times_;
  const GroundColours& colours_;
  const CloseEncounterOptions& options_;
};

}  // namespace

std::vector<CloseEncounter> find_encounters(std::span<const GroundTracklet> tracklets, std::span<const Timestamp> times,
                                            double near) {
  return EncounterDetector(tracklets, times, near).close_encounters();
}

std::optional<double> gain_of_swap(std::span<const GroundSample> a, std::span<const GroundSample> b,
                                   const CloseEncounter& close_encounter, std::span<const Timestamp> times,
                                   const GroundColours& colours, const CloseEncounterOptions& options) {
  return Parting(close_encounter, times, colours, options).gain_of_swap(a, b);
}

}  // namespace marey::track::ground::offline
