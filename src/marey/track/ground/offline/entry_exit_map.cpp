#include "marey/track/ground/offline/entry_exit_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "marey/geometry/median.h"

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

GroundGrid grid_over(std::span<const EntryExitMap::EntryExit> came, std::span<const EntryExitMap::EntryExit> left) {
  std::vector<double> x, y;
  for (const auto& passages : {came, left}) {
    for (const EntryExitMap::EntryExit& one : passages) x.push_back(one.location.x()), y.push_back(one.location.y());
  }
  if (x.empty()) return {};
  return GroundGrid::over({geometry::quantile(x, kFewPassages), geometry::quantile(y, kFewPassages)},
                          {geometry::quantile(x, 1 - kFewPassages), geometry::quantile(y, 1 - kFewPassages)}, kPassageCell);
}

std::vector<double> sums_over(const GroundGrid& grid, std::span<const EntryExitMap::EntryExit> passages, bool weighted) {
  std::vector<double> sums(grid.size(), 0);
  for (const EntryExitMap::EntryExit& one : passages) sums[grid.index(one.location)] += weighted ? one.probability : 1;
  return spread_over(grid, sums, std::max(kReach, grid.cell));
}

}  // namespace

EntryExitMap::EntryExitMap(std::span<const EntryExit> came, std::span<const EntryExit> left, double recorded)
    : grid_(grid_over(came, left)),
      came_(sums_over(grid_, came, true)),
      left_(sums_over(grid_, left, true)),
      ended_(sums_over(grid_, left, false)),
      recorded_(recorded) {}

double EntryExitMap::coming(const EntryExit& one) const {
  const double prior = one.at_border ? kComingAtBorder : kComingInside;
  if (came_.empty()) return prior;
  const double reach = std::max(kReach, grid_.cell);
  const double others = std::max(0.0, came_[grid_.index(one.location)] - one.probability);
  return (others / (2 * std::numbers::pi * reach * reach) + kPriorSeconds * prior) / (recorded_ + kPriorSeconds);
}

double EntryExitMap::leaving(const EntryExit& one) const {
  const double prior = one.at_border ? kLeavingAtBorder : kLeavingInside;
  if (left_.empty()) return prior;
  const std::size_t cell = grid_.index(one.location);
  const double left = std::max(0.0, left_[cell] - one.probability), ended = std::max(left, ended_[cell] - 1);
  return std::clamp((left + kPriorTracks * prior) / (ended + kPriorTracks), 1e-3, 0.999);
}

}  // namespace marey::track::ground::offline
