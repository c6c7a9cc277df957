#include "marey/track/ground/offline/ground_openness.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace marey::track::ground::offline {
namespace {

constexpr double kComingInside = 5e-5;  // people who come from nowhere, per m² and s: 25 people, each lost once in a minute or so
constexpr double kComingAtBorder = 2e-3;
constexpr double kLeavingInside = 0.02;  // probability that a track ends because the person left
constexpr double kLeavingAtBorder = 0.7;
constexpr double kPriorSeconds = 20;    // that the first two count for
constexpr double kPriorTracks = 2;      // that the last two count for
constexpr double kReach = 1.5;          // m, standard deviation: as far round a passage others are likely
constexpr double kPassageCell = 0.75;   // m
constexpr double kFewPassages = 0.002;  // of the passages lie beyond the grid on each side

double quantile_of(std::vector<double> values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

GroundGrid grid_over(std::span<const GroundOpenness::Passage> came, std::span<const GroundOpenness::Passage> left) {
  std::vector<double> x, y;
  for (const auto& passages : {came, left}) {
    for (const GroundOpenness::Passage& one : passages) x.push_back(one.place.x()), y.push_back(one.place.y());
  }
  if (x.empty()) return {};
  return GroundGrid::over({quantile_of(x, kFewPassages), quantile_of(y, kFewPassages)},
                          {quantile_of(x, 1 - kFewPassages), quantile_of(y, 1 - kFewPassages)}, kPassageCell);
}

std::vector<double> sums_over(const GroundGrid& grid, std::span<const GroundOpenness::Passage> passages, bool weighted) {
  std::vector<double> sums(grid.size(), 0);
  for (const GroundOpenness::Passage& one : passages) sums[grid.index(one.place)] += weighted ? one.probability : 1;
  return spread_over(grid, sums, std::max(kReach, grid.cell));
}

}  // namespace

GroundOpenness::GroundOpenness(std::span<const Passage> came, std::span<const Passage> left, double recorded)
    : grid_(grid_over(came, left)),
      came_(sums_over(grid_, came, true)),
      left_(sums_over(grid_, left, true)),
      ended_(sums_over(grid_, left, false)),
      recorded_(recorded) {}

double GroundOpenness::coming(const Passage& one) const {
  const double prior = one.at_border ? kComingAtBorder : kComingInside;
  if (came_.empty()) return prior;
  const double reach = std::max(kReach, grid_.cell);
  const double others = std::max(0.0, came_[grid_.index(one.place)] - one.probability);
  return (others / (2 * std::numbers::pi * reach * reach) + kPriorSeconds * prior) / (recorded_ + kPriorSeconds);
}

double GroundOpenness::leaving(const Passage& one) const {
  const double prior = one.at_border ? kLeavingAtBorder : kLeavingInside;
  if (left_.empty()) return prior;
  const std::size_t cell = grid_.index(one.place);
  const double left = std::max(0.0, left_[cell] - one.probability), ended = std::max(left, ended_[cell] - 1);
  return std::clamp((left + kPriorTracks * prior) / (ended + kPriorTracks), 1e-3, 0.999);
}

}  // namespace marey::track::ground::offline
