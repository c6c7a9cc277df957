#include "marey/pipeline/bodies/same_person.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "marey/geometry/median.h"

namespace marey::pipeline::bodies {
namespace {

constexpr double kSameSizeM = 0.015;  // bench/tuning.md

std::optional<double> median_distance(std::span<const solve::skeleton::ObservedMarkers> frames, std::size_t a, std::size_t b) {
  std::vector<double> distances;
  for (const solve::skeleton::ObservedMarkers& frame : frames) {
    if (frame[a] && frame[b]) distances.push_back((*frame[a] - *frame[b]).norm());
  }
  if (distances.empty()) return std::nullopt;
  return geometry::median(distances);
}

struct Pair {
  std::size_t a = 0, b = 0;
  double change_m = 0;  // of their distance, from the recording to the other
};

/// Of markers on one segment that are in both.
std::vector<Pair> pairs_of(const Skeleton& skeleton, std::span<const solve::skeleton::ObservedMarkers> recording,
                           std::span<const solve::skeleton::ObservedMarkers> other) {
  std::vector<Pair> pairs;
  for (std::size_t a = 0; a < skeleton.markers.size(); ++a) {
    for (std::size_t b = a + 1; b < skeleton.markers.size(); ++b) {
      if (skeleton.markers[a].segment != skeleton.markers[b].segment) continue;
      const auto here = median_distance(recording, a, b), there = median_distance(other, a, b);
      if (here && there) pairs.push_back({a, b, *there - *here});
    }
  }
  return pairs;
}

}  // namespace

std::optional<std::string> other_size(const Skeleton& skeleton, std::span<const solve::skeleton::ObservedMarkers> recording,
                                      std::span<const solve::skeleton::ObservedMarkers> other) {
  double worst = kSameSizeM;
  std::optional<std::string> stated;
  for (const Pair& pair : pairs_of(skeleton, recording, other)) {
    if (std::abs(pair.change_m) <= worst) continue;
    worst = std::abs(pair.change_m);
    stated = fmt::format("{} and {} are {:.0f} mm {}", skeleton.markers[pair.a].label, skeleton.markers[pair.b].label, 1000 * worst,
                         pair.change_m > 0 ? "farther apart" : "closer together");
  }
  return stated;
}

std::vector<std::size_t> moved_markers(const Skeleton& skeleton, std::span<const solve::skeleton::ObservedMarkers> recording,
                                       std::span<const solve::skeleton::ObservedMarkers> other) {
  std::vector<Pair> pairs = pairs_of(skeleton, recording, other);
  std::vector<std::size_t> moved;
  for (;;) {
    std::vector<double> excess(skeleton.markers.size(), 0.0);
    for (const Pair& pair : pairs) {
      const double beyond = std::max(0.0, std::abs(pair.change_m) - kSameSizeM);
      excess[pair.a] += beyond;
      excess[pair.b] += beyond;
    }
    const auto worst = std::max_element(excess.begin(), excess.end());
    if (worst == excess.end() || !(*worst > 0)) return moved;
    const auto marker = static_cast<std::size_t>(worst - excess.begin());
    moved.push_back(marker);
    std::erase_if(pairs, [&](const Pair& pair) { return pair.a == marker || pair.b == marker; });
  }
}

}  // namespace marey::pipeline::bodies
