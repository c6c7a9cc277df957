#include "marey/evaluate/ground_evaluation.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "marey/evaluate/evaluate_tracks.h"

namespace marey::evaluate {
namespace {

[[maybe_unused]] bool positions_by_frame(const TargetPosition& a, const TargetPosition& b) {
  return a.frame < b.frame;
}

/// The value below which this share of all lies, between neighbours by their distance.
double quantile(const std::vector<double>& sorted, double fraction) {
  const double at = fraction * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], at - static_cast<double>(below));
}

std::optional<ErrorSpread> spread_of(std::vector<double>& errors) {
  if (errors.empty()) return std::nullopt;
  std::sort(errors.begin(), errors.end());
  const double squares = std::inner_product(errors.begin(), errors.end(), errors.begin(), 0.0);
  return ErrorSpread{std::sqrt(squares / static_cast<double>(errors.size())), quantile(errors, 0.5), quantile(errors, 0.95)};
}

}  // namespace

GroundEvaluation evaluate_ground(std::span<const TargetPosition> truth, std::span<const TargetPosition> tracks, double farthest) {
  assert(std::is_sorted(truth.begin(), truth.end(), positions_by_frame) && "truth is ordered by frame");
  assert(std::is_sorted(tracks.begin(), tracks.end(), positions_by_frame) && "tracks are ordered by frame");
  assert(farthest > 0 && "a distance up to which a person counts as found");
  std::vector<double> position, speed, velocity;
  const auto close = [farthest](const TargetPosition& a, const TargetPosition& b) {
    const double distance = (a.location - b.location).norm();
    return Closeness{distance, std::max(0.0, 1 - distance / farthest)};
  };
  const auto matched = [&](const auto& walk, const ClearCounter& clear) {
    for (std::size_t row = 0; row < walk.rows().size(); ++row) {
      const int column = clear.column_of_row()[row];
      if (column == assign::kNoIndex) continue;
      const TargetPosition &is = walk.rows()[row], &stated = walk.columns()[static_cast<std::size_t>(column)];
      position.push_back((is.location - stated.location).norm());
      if (!is.velocity || !stated.velocity) continue;
      speed.push_back(std::abs(is.velocity->norm() - stated.velocity->norm()));
      velocity.push_back((*is.velocity - *stated.velocity).norm());
    }
  };
  const Evaluated evaluated = assess(truth, tracks, farthest, close, matched);
  GroundEvaluation result;
  result.scores = evaluated.scores;
  const IdNumbers people(truth), names(tracks);
  for (std::size_t i = 0; i < evaluated.objects.size(); ++i) {
    const ClearCounter::Object& object = evaluated.objects[i];
    TargetFate& fate = result.people.emplace_back();
    fate.id = people.id(static_cast<int>(i));
    if (evaluated.track_of_object[i] != assign::kNoIndex) fate.track = names.id(evaluated.track_of_object[i]);
    fate.frames = object.frames, fate.found = object.found, fate.switches = object.switches;
    fate.agreeing = evaluated.agreeing[i];
  }
  result.position = spread_of(position);
  result.speed = spread_of(speed);
  result.velocity = spread_of(velocity);
  return result;
}

}  // namespace marey::evaluate
