#include "marey/detect/shirts/number_strings.h"

#include <vector>

#include <fmt/format.h>

namespace marey::detect::shirts {
namespace {

constexpr std::size_t kMaxLabels = 5;  // by definition: blank, digit, blank, digit, blank

/// The likelihood of `labels`, classes with a blank before, between and after the digits, by the forward recursion of Graves et
/// al., "Connectionist temporal classification", 2006.
double likelihood_of(std::span<const int> labels, std::span<const std::array<double, kColumnClasses>> columns) {
  std::array<double, kMaxLabels> at{};
  at[0] = 1;  // before the first column; as if a blank were there
  for (std::size_t t = 0; t < columns.size(); ++t) {
    std::array<double, kMaxLabels> next{};
    for (std::size_t k = 0; k < labels.size(); ++k) {
      double from = at[k];
      if (k > 0) from += at[k - 1];
      if (k > 1 && labels[k] != 0 && labels[k] != labels[k - 2] && t > 0) from += at[k - 2];
      next[k] = from * columns[t][static_cast<std::size_t>(labels[k])];
    }
    at = next;
  }
  return labels.size() == 1 ? at[0] : at[labels.size() - 1] + at[labels.size() - 2];
}

}  // namespace

std::string string_at(int index) {
  if (index == 0) return {};
  if (index <= kDigits) return fmt::format("{}", index - 1);
  return fmt::format("{:02}", index - 1 - kDigits);
}

StringProbabilities string_likelihoods(std::span<const std::array<double, kColumnClasses>> columns) {
  StringProbabilities found{};
  found[0] = likelihood_of(std::array{0}, columns);
  for (int a = 0; a < kDigits; ++a) {
    found[static_cast<std::size_t>(string_index(-1, a))] = likelihood_of(std::array{0, 1 + a, 0}, columns);
    for (int b = 0; b < kDigits; ++b)
      found[static_cast<std::size_t>(string_index(a, b))] = likelihood_of(std::array{0, 1 + a, 0, 1 + b, 0}, columns);
  }
  return found;
}

}  // namespace marey::detect::shirts
