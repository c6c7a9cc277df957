#include "marey/analyse/gait/gait_profile.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

namespace marey::analyse::gait {
namespace {

constexpr std::size_t kMinScoredPeople = 3;  // by definition: two others have a mean that is not one person's

struct MeanAndDeviation {
  std::optional<double> mean, deviation;
};

MeanAndDeviation over(std::span<const double> values) {
  MeanAndDeviation result;
  if (values.empty()) return result;
  const auto count = static_cast<double>(values.size());
  result.mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  double squares = 0;
  for (const double v : values) squares += (v - *result.mean) * (v - *result.mean);
  if (values.size() > 1) result.deviation = std::sqrt(squares / (count - 1));
  return result;
}

double mean_of(const CyclePoints& points) {
  return std::accumulate(points.begin(), points.end(), 0.0) / static_cast<double>(kCyclePoints);
}

/// The whole turns that bring `points` to `near`.
double revolutions_between(const CyclePoints& points, const CyclePoints& near) {
  return 2 * std::numbers::pi * std::round((mean_of(near) - mean_of(points)) / (2 * std::numbers::pi));
}

/// One person's curve, left and right cycles alike; nothing if no cycle has it.
std::optional<CyclePoints> person_curve(const ReferencePerson& person, std::string_view name) {
  CyclePoints sum{};
  std::size_t count = 0;
  std::optional<CyclePoints> first;
  for (const CycleCurve& curve : person.curves) {
    if (without_side(curve.name) != name) continue;
    for (const CyclePoints& cycle : curve.cycles) {
      if (!first) first = cycle;
      const double turns = revolutions_between(cycle, *first);
      for (std::size_t p = 0; p < kCyclePoints; ++p) sum[p] += cycle[p] + turns;
      ++count;
    }
  }
  if (count == 0) return std::nullopt;
  for (double& point : sum) point /= static_cast<double>(count);
  return sum;
}

std::vector<std::string> names_of_curves(std::span<const ReferencePerson> people) {
  std::vector<std::string> names;
  for (const ReferencePerson& person : people) {
    for (const CycleCurve& curve : person.curves) {
      if (std::find(names.begin(), names.end(), without_side(curve.name)) == names.end())
        names.emplace_back(without_side(curve.name));
    }
  }
  return names;
}

const CycleCurve* find_curve(std::span<const CycleCurve> curves, Side side, std::string_view name) {
  for (const CycleCurve& curve : curves) {
    if (side_of_curve(curve.name) == side && without_side(curve.name) == name && !curve.cycles.empty()) return &curve;
  }
  return nullptr;
}

std::optional<double> rms(std::span<const std::optional<double>> scores) {
  double squares = 0;
  for (const auto& score : scores) {
    if (!score) return std::nullopt;
    squares += *score * *score;
  }
  return std::sqrt(squares / static_cast<double>(scores.size()));
}

/// GVS by cycle, in the order of `kProfileVariables`.
using CycleScores = std::map<std::size_t, std::array<std::optional<double>, kProfileVariables.size()>>;

CycleScores scores_of_cycles(std::span<const CycleCurve> curves, std::span<const ReferenceBand> reference, Side side) {
  CycleScores scores;
  for (std::size_t v = 0; v < kProfileVariables.size(); ++v) {
    const CycleCurve* curve = find_curve(curves, side, kProfileVariables[v]);
    const auto band =
        std::find_if(reference.begin(), reference.end(), [&](const ReferenceBand& of) { return of.name == kProfileVariables[v]; });
    if (curve == nullptr || band == reference.end()) continue;
    for (std::size_t c = 0; c < curve->cycles.size(); ++c)
      scores[curve->cycle_of[c]][v] = rms_difference(curve->cycles[c], band->mean);
  }
  return scores;
}

}  // namespace

double rms_difference(const CyclePoints& a, const CyclePoints& b) {
  const double turns = revolutions_between(a, b);
  double squares = 0;
  for (std::size_t p = 0; p < kCyclePoints; ++p) squares += (a[p] + turns - b[p]) * (a[p] + turns - b[p]);
  return std::sqrt(squares / static_cast<double>(kCyclePoints));
}

std::vector<ReferenceBand> reference_bands(std::span<const ReferencePerson> people, std::optional<std::size_t> omitted) {
  std::vector<ReferenceBand> bands;
  for (const std::string& name : names_of_curves(people)) {
    std::vector<CyclePoints> curves;
    for (std::size_t i = 0; i < people.size(); ++i) {
      if (i == omitted) continue;
      auto curve = person_curve(people[i], name);
      if (!curve) continue;
      const double turns = curves.empty() ? 0 : revolutions_between(*curve, curves.front());
      for (double& point : *curve) point += turns;
      curves.push_back(*curve);
    }
    if (curves.empty()) continue;
    ReferenceBand band{.name = name, .people = curves.size()};
    summarise(curves, band.mean, band.deviation);
    bands.push_back(std::move(band));
  }
  return bands;
}

std::vector<ReferenceSignal> reference_signals(std::span<const ReferencePerson> people) {
  std::map<std::pair<std::string, std::string>, std::vector<CyclePoints>> of_people;  // by label and unit
  for (const ReferencePerson& person : people) {
    std::map<std::pair<std::string, std::string>, std::vector<CyclePoints>> own;
    for (const SignalCurve& signal : person.signals) {
      if (!signal.unit.ends_with("/kg") && signal.unit != kPercentOfWeight) continue;
      auto& cycles = own[{signal.label, signal.unit}];
      cycles.insert(cycles.end(), signal.cycles.begin(), signal.cycles.end());
    }
    for (const auto& [name, cycles] : own) {
      if (cycles.empty()) continue;
      CyclePoints mean{}, deviation{};
      summarise(cycles, mean, deviation);
      of_people[name].push_back(mean);
    }
  }
  std::vector<ReferenceSignal> signals;
  for (const auto& [name, means] : of_people) {
    ReferenceSignal signal{.label = name.first, .unit = name.second, .people = means.size()};
    summarise(means, signal.mean, signal.deviation);
    signals.push_back(std::move(signal));
  }
  return signals;
}

std::vector<ReferenceFigure> reference_figures(std::span<const ReferencePerson> people) {
  std::vector<ReferenceFigure> figures;
  std::map<std::string, std::vector<double>> values;
  for (const ReferencePerson& person : people) {
    for (const GaitFigure& figure : person.figures) {
      std::vector<double> sides;
      for (const auto& mean : figure.mean) {
        if (mean) sides.push_back(*mean);
      }
      if (sides.empty()) continue;
      if (!values.contains(figure.name)) figures.push_back({.name = figure.name, .unit = figure.unit, .deviation = {}});
      values[figure.name].push_back(*over(sides).mean);
    }
  }
  for (ReferenceFigure& figure : figures) {
    const MeanAndDeviation all = over(values[figure.name]);
    figure.people = values[figure.name].size();
    figure.mean = *all.mean;
    figure.deviation = all.deviation;
  }
  return figures;
}

std::vector<ReferenceScore> reference_scores(std::span<const ReferencePerson> people) {
  std::vector<ReferenceScore> scores;
  if (people.size() < kMinScoredPeople) return scores;
  std::map<std::string, std::vector<double>> values;
  for (std::size_t i = 0; i < people.size(); ++i) {
    const GaitProfile profile = gait_profile(people[i].curves, reference_bands(people, i));
    const auto add = [&](const std::string& name, const std::array<std::optional<double>, 2>& sides) {
      std::vector<double> known;
      for (const auto& side : sides) {
        if (side) known.push_back(*side);
      }
      if (!known.empty()) values[name].push_back(*over(known).mean);
    };
    for (const VariableScore& variable : profile.variables) add(variable.name, variable.mean);
    add("GPS", profile.score);
  }
  const auto take = [&](const std::string& name) {
    const MeanAndDeviation all = over(values[name]);
    if (all.mean && all.deviation) scores.push_back({name, *all.mean, *all.deviation});
  };
  for (const std::string_view name : kProfileVariables) take(std::string(name));
  take("GPS");
  return scores;
}

GaitProfile gait_profile(std::span<const CycleCurve> curves, std::span<const ReferenceBand> reference) {
  GaitProfile profile;
  for (const std::string_view name : kProfileVariables) profile.variables.push_back({std::string(name), {}, {}});
  for (const Side side : kSides) {
    const auto s = static_cast<std::size_t>(side);
    const CycleScores by_cycle = scores_of_cycles(curves, reference, side);
    std::array<std::optional<double>, kProfileVariables.size()> means;
    for (std::size_t v = 0; v < kProfileVariables.size(); ++v) {
      std::vector<double> known;
      for (const auto& [cycle, scores] : by_cycle) {
        if (scores[v]) known.push_back(*scores[v]);
      }
      const MeanAndDeviation all = over(known);
      means[v] = profile.variables[v].mean[s] = all.mean;
      profile.variables[v].deviation[s] = all.deviation;
    }
    profile.score[s] = rms(means);
    std::vector<double> whole;
    for (const auto& [cycle, scores] : by_cycle) {
      if (const auto score = rms(scores)) whole.push_back(*score);
    }
    if (profile.score[s]) profile.score_deviation[s] = over(whole).deviation;
  }
  std::vector<std::optional<double>> fifteen;
  for (std::size_t v = 0; v < kProfileVariables.size(); ++v) {
    fifteen.push_back(profile.variables[v].mean[0]);
    if (v >= kPelvisVariables) fifteen.push_back(profile.variables[v].mean[1]);
  }
  profile.overall = rms(fifteen);
  return profile;
}

}  // namespace marey::analyse::gait
