#include "marey/pipeline/bodies/gait_quality.h"

#include <algorithm>
#include <map>

#include "marey/geometry/median.h"

namespace marey::pipeline::bodies {
namespace {

std::optional<GaitQuality::Pair> pair_of(const GaitMarkers& walk, const gait::MarkerPositions& standing, std::string_view first,
                                         std::string_view second) {
  std::vector<double> distances;
  for (const gait::MarkerPositions& row : walk.rows) {
    const auto a = row.find(first), b = row.find(second);
    if (a != row.end() && b != row.end()) distances.push_back((a->second - b->second).norm());
  }
  if (distances.empty()) return std::nullopt;
  std::sort(distances.begin(), distances.end());
  const auto at = [&](double fraction) {
    return distances[static_cast<std::size_t>(fraction * static_cast<double>(distances.size() - 1))];
  };
  GaitQuality::Pair pair{.first = std::string(first),
                         .second = std::string(second),
                         .distance_m = at(0.5),
                         .range_m = at(0.95) - at(0.05),
                         .to_static_m = {}};
  const auto a = standing.find(first), b = standing.find(second);
  if (a != standing.end() && b != standing.end()) pair.to_static_m = pair.distance_m - (a->second - b->second).norm();
  return pair;
}

GaitQuality::Gaps gaps_of(const GaitMarkers& walk, const std::string& label) {
  std::size_t missing = 0, longest = 0, now = 0;
  for (const gait::MarkerPositions& row : walk.rows) {
    now = row.contains(label) ? 0 : now + 1;
    missing += now > 0 ? 1 : 0;
    longest = std::max(longest, now);
  }
  return {.marker = label,
          .missing_fraction = static_cast<double>(missing) / static_cast<double>(walk.rows.size()),
          .longest_s = static_cast<double>(longest) / walk.rate_hz};
}

}  // namespace

GaitQuality gait_quality(const GaitMarkers& walk, const gait::MarkerPositions& standing) {
  GaitQuality quality;
  std::map<std::string, bool> present;
  for (const gait::MarkerPositions& row : walk.rows) {
    for (const auto& [label, position] : row) present[label] = true;
  }
  quality.markers = present.size();
  for (const std::string_view label : gait::plug_in_gait_markers()) {
    if (!present.contains(std::string(label))) quality.absent.emplace_back(label);
  }
  for (const auto& [label, is] : present) {
    GaitQuality::Gaps gaps = gaps_of(walk, label);
    if (gaps.missing_fraction > 0) quality.gaps.push_back(std::move(gaps));
  }
  for (const auto& [first, second] : rigid_marker_pairs()) {
    if (auto pair = pair_of(walk, standing, first, second)) quality.pairs.push_back(std::move(*pair));
  }
  std::stable_sort(quality.pairs.begin(), quality.pairs.end(), [](const auto& a, const auto& b) { return a.range_m > b.range_m; });
  return quality;
}

}  // namespace marey::pipeline::bodies
