#include "marey/pipeline/bodies/same_person.h"

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

}  // namespace

std::optional<std::string> other_size(const Skeleton& skeleton, std::span<const solve::skeleton::ObservedMarkers> recording,
                                      std::span<const solve::skeleton::ObservedMarkers> other) {
  double worst = kSameSizeM;
  std::optional<std::string> stated;
  for (std::size_t a = 0; a < skeleton.markers.size(); ++a) {
    for (std::size_t b = a + 1; b < skeleton.markers.size(); ++b) {
      if (skeleton.markers[a].segment != skeleton.markers[b].segment) continue;
      const auto here = median_distance(recording, a, b), there = median_distance(other, a, b);
      if (!here || !there || std::abs(*there - *here) <= worst) continue;
      worst = std::abs(*there - *here);
      stated = fmt::format("{} and {} are {:.0f} mm {}", skeleton.markers[a].label, skeleton.markers[b].label, 1000 * worst,
                           *there > *here ? "farther apart" : "closer together");
    }
  }
  return stated;
}

}  // namespace marey::pipeline::bodies
