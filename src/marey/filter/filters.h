#pragma once

#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "marey/filter/alpha_beta.h"
#include "marey/filter/alpha_beta_variable.h"
#include "marey/filter/condensation.h"
#include "marey/filter/custom_filter.h"
#include "marey/filter/extended_kalman.h"
#include "marey/filter/extrapolation.h"
#include "marey/filter/filter.h"
#include "marey/filter/interacting_models.h"
#include "marey/filter/kalman.h"
#include "marey/filter/kalman_acceleration.h"
#include "marey/filter/kalman_paper.h"
#include "marey/filter/unscented_kalman.h"

namespace marey::filter {

/// The register of filters: which one, with its parameters. To add a filter, write it as a model of Filter and name its options
/// here; every place that must know of it then fails to compile until it does.
using FilterOptions = std::variant<KalmanOptions, AlphaBetaOptions, AlphaBetaVariableOptions, KalmanPaperOptions,
                                   KalmanAccelerationOptions, ExtendedKalmanOptions, UnscentedKalmanOptions, CondensationOptions,
                                   ExtrapolationOptions, InteractingModelsOptions, CustomFilterOptions>;

/// Calls `visitor.template operator()<F>(options)` with the filter type F for dimension D that `options` chooses.
template <int D, typename Visitor>
decltype(auto) with_filter(const FilterOptions& options, Visitor&& visitor) {
  return std::visit(
      // Its type is written out: where it must be deduced within std::visit, clang 19 forgets to make virtual functions.
      [&]<typename Options, typename F = typename Options::template Model<D>>(
          const Options& chosen) -> decltype(std::forward<Visitor>(visitor).template operator()<F>(chosen)) {
        static_assert(Filter<F>);
        return std::forward<Visitor>(visitor).template operator()<F>(chosen);
      },
      options);
}

/// The same filter for a unit of length that is 1 / factor of this one.
FilterOptions scaled(const FilterOptions& options, double factor);

/// A filter as the command line names it, with its default parameters.
struct NamedFilter {
  std::string_view name;
  std::string_view meaning;  ///< one line, for help
  FilterOptions options;
};

/// Every filter but those that are brought from outside, the simplest first.
const std::vector<NamedFilter>& named_filters();

/// Its default parameters, in pixels. Throws marey::Error, listing the names, if this name does not exist.
FilterOptions filter_named(std::string_view name);

/// The name of the filter that `options` are for.
std::string_view name_of(const FilterOptions& options);

}  // namespace marey::filter
