#include "marey/edit/fill_trials.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "marey/geometry/median.h"

namespace marey::edit {
namespace {

using Path = std::vector<Vector<3>>;

constexpr std::size_t kMaxTrials = 24;    // holes of a length
constexpr std::size_t kEnoughTrials = 6;  // of the gap's length: these are spread over 2.7 times as much
constexpr std::size_t kMinTrials = 3;     // of others
constexpr double kMinShape = 0.25;        // of an error against that in the middle of its hole: the rims show little
// Of how many times as large an error is where the hole is twice as long, the logarithm to base 2. Measured on 184 gaps of 0.25 to
// 1 s in walks, punches, squats and a run that have room for all lengths: medians of 0.75 (pattern), 1.0 (rigid) and 2.3 (spline);
// that from a quarter to a half predicts that from there to the whole (correlation 0.6 and 0.65, but 0.2 of the spline).
constexpr double kGrowth = 1, kSplineGrowth = 2.3, kMinGrowth = 0.5;
constexpr double kShortUntried_s = 0.15;  // where nothing can be tried: a polynomial up to here
constexpr double kUntriedFraction = 0.1;  // and what it is expected to be off, as a share of how far the marker went

constexpr double kWithinTwo = 0.95;       // by definition: the share of errors that two deviations hold
constexpr double kMinDeviation_m = 1e-5;  // numerical

FillScore larger(const FillScore& a, const FillScore& b) {
  return {.typical_m = std::max(a.typical_m, b.typical_m), .expected_m = std::max(a.expected_m, b.expected_m)};
}

}  // namespace

std::optional<Path> filled(FillMethod method, const Locations& locations, const Hole& hole, std::span<const std::size_t> donors,
                           const Hole& hidden) {
  if (method == FillMethod::spline) return spline_fill(locations, 0, hole);
  if (method == FillMethod::rigid) return rigid_fill(locations, 0, hole, donors);
  return pattern_fill(locations, 0, hole, donors, hidden);
}

FillTrials::FillTrials(const Locations& locations, const Hole& gap, std::span<const std::size_t> donors)
    : locations_(locations), gap_(gap), donors_(donors) {
  groups_.push_back(inside(gap.size()));
  if (groups_[0].holes.size() >= kEnoughTrials) return;
  groups_.push_back(inside(gap.size() / 2));
  groups_.push_back(inside(gap.size() / 4));
  around_ = around();
}

/// Where the marker and the donors were seen: the nearest ones, on both sides.
FillTrials::Group FillTrials::inside(std::size_t length) const {
  Group group{.length = length, .holes = {}};
  if (length < 3 && length != gap_.size()) return group;
  const std::size_t step = std::max<std::size_t>(1, length / 3);
  for (std::size_t first = 1; first + length < locations_.size(); first += step) {
    const Hole hole{first, first + length - 1};
    const bool whole = locations_.markers[0].spans(hole) && std::all_of(donors_.begin(), donors_.end(), [&](std::size_t donor) {
                         return locations_.markers[donor].spans(hole);
                       });
    if (whole) group.holes.push_back(hole);
  }
  const auto away = [&](const Hole& hole) { return std::abs(static_cast<double>(hole.first) - static_cast<double>(gap_.first)); };
  std::stable_sort(group.holes.begin(), group.holes.end(), [&](const Hole& a, const Hole& b) { return away(a) < away(b); });
  if (group.holes.size() > kMaxTrials) group.holes.resize(kMaxTrials);
  return group;
}

/// The gap, and up to a half of it more on either side.
std::vector<Hole> FillTrials::around() const {
  std::vector<Hole> holes;
  const std::size_t step = std::max<std::size_t>(1, gap_.size() / 6);
  for (std::size_t before = 0; before <= 3; ++before) {
    for (std::size_t behind = 0; behind <= 3; ++behind) {
      if (before + behind == 0 || gap_.first < before * step + 1) continue;
      const Hole hole{gap_.first - before * step, gap_.last + behind * step};
      if (hole.last + 1 >= locations_.size()) continue;
      const auto& known = locations_.markers[0].known;
      const auto all = [&](std::size_t from, std::size_t to) {
        return std::all_of(known.begin() + static_cast<std::ptrdiff_t>(from), known.begin() + static_cast<std::ptrdiff_t>(to) + 1,
                           [](char one) { return one != 0; });
      };
      if (!all(hole.first - 1, gap_.first - 1) || !all(gap_.last + 1, hole.last + 1)) continue;
      if (std::all_of(donors_.begin(), donors_.end(), [&](std::size_t donor) { return locations_.markers[donor].spans(hole); }))
        holes.push_back(hole);
    }
  }
  return holes;
}

/// Brought to the middle of their hole, where they are largest.
std::vector<double> FillTrials::errors(FillMethod method, std::span<const Hole> holes) const {
  std::vector<double> errors;
  for (const Hole& hole : holes) {
    const auto path = filled(method, locations_, hole, donors_, gap_);
    if (!path) continue;
    for (std::size_t i = 0; i < path->size(); ++i) {
      const std::size_t frame = hole.first + i;
      const double fraction = static_cast<double>(i + 1) / static_cast<double>(path->size() + 1),
                   shape = 4 * fraction * (1 - fraction);
      if (shape < kMinShape || locations_.markers[0].known[frame] == 0 || (gap_.first <= frame && frame <= gap_.last)) continue;
      errors.push_back(((*path)[i] - locations_.markers[0].location[frame]).norm() / std::sqrt(shape));
    }
  }
  return errors;
}

FillScore FillTrials::of(FillMethod method, std::span<const Hole> holes) const {
  std::vector<double> all = errors(method, holes);
  if (all.empty()) return {};
  return {.typical_m = geometry::median(all), .expected_m = std::max(0.5 * geometry::quantile(all, kWithinTwo), kMinDeviation_m)};
}

FillScore FillTrials::score(FillMethod method) const {
  const FillScore full = of(method, groups_[0].holes);
  if (groups_.size() == 1) return full.expected_m > 0 ? full : untried(method);
  FillScore score = full;
  if (around_.size() >= kMinTrials) score = larger(score, of(method, around_));
  if (score.expected_m == 0) score = scaled(method);
  return score.expected_m > 0 ? score : untried(method);
}

/// From shorter holes, by how much errors grow from one length to its double.
FillScore FillTrials::scaled(FillMethod method) const {
  const FillScore half = of(method, groups_[1].holes), quarter = of(method, groups_[2].holes);
  const auto reported = [&](std::size_t group, const FillScore& score) {
    return groups_[group].holes.size() >= kMinTrials && score.expected_m > 0;
  };
  double growth = method == FillMethod::spline ? kSplineGrowth : kGrowth;
  if (reported(1, half) && reported(2, quarter)) {
    const double doublings = std::log2(static_cast<double>(groups_[1].length) / static_cast<double>(groups_[2].length));
    growth = std::clamp(std::log2(half.expected_m / quarter.expected_m) / doublings, kMinGrowth, 2 * growth);
  }
  const std::size_t group = reported(1, half) ? 1 : 2;
  const FillScore& from = group == 1 ? half : quarter;
  if (!reported(group, from)) return {};
  const double times = std::pow(static_cast<double>(gap_.size()) / static_cast<double>(groups_[group].length), growth);
  return {.typical_m = from.typical_m * times, .expected_m = from.expected_m * times};
}

/// What the field's rule says.
FillScore FillTrials::untried(FillMethod method) const {
  const bool brief = static_cast<double>(gap_.size()) <= kShortUntried_s * locations_.rate_hz;
  const double went = (locations_.markers[0].location[gap_.last + 1] - locations_.markers[0].location[gap_.first - 1]).norm();
  const double rank = method == FillMethod::rigid ? 1 : (method == FillMethod::spline) == brief ? 0 : 2;
  return {1 + rank, std::max(kUntriedFraction * went, 0.005)};
}

}  // namespace marey::edit
