#include "marey/filter/filters.h"

#include <algorithm>

#include <fmt/ranges.h>

#include "marey/core/error.h"

namespace marey::filter {
namespace {

/// Two filters of one type differ in a switch among their options.
bool same_filter(const FilterOptions& a, const FilterOptions& b) {
  if (a.index() != b.index()) return false;
  const auto* particles_a = std::get_if<CondensationOptions>(&a);
  const auto* particles_b = std::get_if<CondensationOptions>(&b);
  return particles_a == nullptr || particles_a->with_velocity == particles_b->with_velocity;
}

}  // namespace

FilterOptions scaled(const FilterOptions& options, double factor) {
  return std::visit([&](const auto& chosen) -> FilterOptions { return chosen.scaled(factor); }, options);
}

const std::vector<NamedFilter>& named_filters() {
  static const std::vector<NamedFilter> filters = {
      {"alpha-beta", "steady velocity, fixed gains, fixed search circle", AlphaBetaOptions{}},
      {"alpha-beta-variable", "the same with a search circle that grows with speed", AlphaBetaVariableOptions{}},
      {"extrapolation", "the parabola through the last three positions", ExtrapolationOptions{}},
      {"kalman", "Kalman, constant velocity", KalmanOptions{}},
      {"kalman-paper", "Kalman as in the OpenMoCap paper, steps counted in frames", KalmanPaperOptions{}},
      {"kalman-acceleration", "Kalman, constant acceleration", KalmanAccelerationOptions{}},
      {"ekf", "extended Kalman, coordinated turn", ExtendedKalmanOptions{}},
      {"ukf", "unscented Kalman, coordinated turn", UnscentedKalmanOptions{}},
      {"condensation", "particles with a position alone", CondensationOptions{}},
      {"condensation-velocity", "particles with position and velocity", CondensationOptions::velocity()},
      {"imm", "interacting models: steady, pull and turn", InteractingModelsOptions{}},
  };
  return filters;
}

FilterOptions filter_named(std::string_view name) {
  const auto& filters = named_filters();
  const auto found = std::find_if(filters.begin(), filters.end(), [&](const NamedFilter& filter) { return filter.name == name; });
  if (found != filters.end()) return found->options;
  std::vector<std::string_view> names;
  for (const NamedFilter& filter : filters) names.push_back(filter.name);
  throw Error("filter \"{}\" is not known; choose one of {}", name, fmt::join(names, ", "));
}

std::string_view name_of(const FilterOptions& options) {
  if (const auto* custom = std::get_if<CustomFilterOptions>(&options)) return custom->name;
  const auto& filters = named_filters();
  return std::find_if(filters.begin(), filters.end(), [&](const NamedFilter& f) { return same_filter(f.options, options); })->name;
}

}  // namespace marey::filter
