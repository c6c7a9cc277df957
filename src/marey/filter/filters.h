#pragma once

#include <utility>
#include <variant>

#include "marey/filter/alpha_beta.h"
#include "marey/filter/filter.h"
#include "marey/filter/kalman.h"

namespace marey {

/// The register of filters: which one, with its parameters. To add a filter, write it as a model of Filter and name its options
/// here; every place that must know of it then fails to compile until it does.
using FilterOptions = std::variant<KalmanOptions, AlphaBetaOptions>;

/// Calls `visitor.template operator()<F>(options)` with the filter type F for dimension D that `options` chooses.
template <int D, typename Visitor>
decltype(auto) with_filter(const FilterOptions& options, Visitor&& visitor) {
  return std::visit(
      [&]<typename Options>(const Options& chosen) -> decltype(auto) {
        using F = typename Options::template Model<D>;
        static_assert(Filter<F>);
        return std::forward<Visitor>(visitor).template operator()<F>(chosen);
      },
      options);
}

}  // namespace marey
