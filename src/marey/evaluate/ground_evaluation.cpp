#include "marey/evaluate/ground_evaluation.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "marey/evaluate/judge.h"

namespace marey::evaluate {
namespace {

[[maybe_unused]] bool places_by_frame(const TargetPlace& a, const TargetPlace& b) {
  return a.frame < b.frame;
}

/// The value below which this share of all lies, between neighbours by their distance.
double quantile(const std::vector<double>& sorted, double share) {
  const double at = share * static_cast<double>(sorted.size() - 1);
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

GroundEvaluation evaluate_ground(std::span<const TargetPlace> truth, std::span<const TargetPlace> tracks, double farthest) {
  assert(std::is_sorted(truth.begin(), truth.end(), places_by_frame) && "truth is ordered by frame");
  assert(std::is_sorted(tracks.begin(), tracks.end(), places_by_frame) && "tracks are ordered by frame");
  assert(farthest > 0 && "a distance up to which someone counts as found");
  std::vector<double> position, speed, velocity;
  const auto close = [farthest](const TargetPlace& a, const TargetPlace& b) {
    const double distance = (a.place - b.place).norm();
    return Closeness{distance, std::max(0.0, 1 - distance / farthest)};
  };
  const auto matched = [&](const auto& walk, const ClearCounter& clear) {
    for (std::size_t row = 0; row < walk.rows().size(); ++row) {
      const int column = clear.column_of_row()[row];
      if (column == assign::kNoIndex) continue;
      const TargetPlace &is = walk.rows()[row], &said = walk.columns()[static_cast<std::size_t>(column)];
      position.push_back((is.place - said.place).norm());
      if (!is.velocity || !said.velocity) continue;
      speed.push_back(std::abs(is.velocity->norm() - said.velocity->norm()));
      velocity.push_back((*is.velocity - *said.velocity).norm());
    }
  };
  const Judged judged = judge(truth, tracks, farthest, close, matched);
  GroundEvaluation result;
  result.scores = judged.scores;
  const IdNumbers people(truth), names(tracks);
  for (std::size_t i = 0; i < judged.objects.size(); ++i) {
    const ClearCounter::Object& object = judged.objects[i];
    TargetFate& fate = result.people.emplace_back();
    fate.id = people.id(static_cast<int>(i));
    if (judged.track_of_object[i] != assign::kNoIndex) fate.track = names.id(judged.track_of_object[i]);
    fate.frames = object.frames, fate.found = object.found, fate.switches = object.switches;
    fate.agreeing = judged.agreeing[i];
  }
  result.position = spread_of(position);
  result.speed = spread_of(speed);
  result.velocity = spread_of(velocity);
  return result;
}

}  // namespace marey::evaluate
