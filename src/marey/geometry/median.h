// The one median, and the order statistic that it is. Cost: linear in the number of values, on average.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <iterator>
#include <optional>
#include <ranges>
#include <vector>

namespace marey::geometry {

/// The value that has `n` others before it in the order of `less`; n < number of values. Reorders `values`.
template <std::ranges::random_access_range Values, typename Less = std::less<>>
std::ranges::range_value_t<Values> nth_value(Values&& values, std::size_t n, Less less = {}) {
  const auto at = std::ranges::begin(values) + static_cast<std::ptrdiff_t>(n);
  std::nth_element(std::ranges::begin(values), at, std::ranges::end(values), less);
  return *at;
}

/// The median of at least one value; of an even number, the greater of the two in the middle. Reorders `values`.
template <std::ranges::random_access_range Values, typename Less = std::less<>>
std::ranges::range_value_t<Values> median(Values&& values, Less less = {}) {
  return nth_value(values, std::ranges::size(values) / 2, less);
}

/// The same, or `otherwise` of no values.
template <std::ranges::random_access_range Values>
std::ranges::range_value_t<Values> median_or(Values&& values, std::ranges::range_value_t<Values> otherwise) {
  return std::ranges::empty(values) ? otherwise : median(values);
}

/// The value that a share of the others, in [0, 1], is before at least; 0 of no values. Reorders `values`.
template <std::ranges::random_access_range Values>
std::ranges::range_value_t<Values> quantile(Values&& values, double fraction) {
  const std::size_t count = std::ranges::size(values);
  if (count == 0) return 0;
  return nth_value(values, static_cast<std::size_t>(fraction * static_cast<double>(count - 1)));
}

struct WeightedValue {
  double value = 0, weight = 0;
};

/// The first value, in order, up to which half of the weight lies; nothing if all weights are 0. Weights are not negative.
/// Sorts `values`.
inline std::optional<double> weighted_median(std::vector<WeightedValue>& values) {
  std::sort(values.begin(), values.end(), [](const WeightedValue& a, const WeightedValue& b) { return a.value < b.value; });
  double total = 0, below = 0;
  for (const WeightedValue& one : values) total += one.weight;
  for (const WeightedValue& one : values) {
    below += one.weight;
    if (2 * below >= total && total > 0) return one.value;
  }
  return std::nullopt;
}

}  // namespace marey::geometry
