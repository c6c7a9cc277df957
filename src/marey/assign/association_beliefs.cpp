#include "marey/assign/association_beliefs.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace marey::assign {
namespace {

constexpr int kMessages = 15;   // of messages between rows and columns
constexpr double kSurest = 30;  // logarithm of odds: surer pairs count no more

}  // namespace

std::vector<double> association_beliefs(int rows, int columns, std::span<const GatedPair> pairs) {
  const auto row = [&](std::size_t pair) { return static_cast<std::size_t>(pairs[pair].row); };
  const auto column = [&](std::size_t pair) { return static_cast<std::size_t>(pairs[pair].column); };
  std::vector<double> odds;
  for (const GatedPair& pair : pairs) odds.push_back(std::exp(std::min(kSurest, pair.gain)));
  std::vector<double> to_columns(odds.size(), 0), to_rows(odds.size(), 1), sums;
  const auto sum_rows = [&] {
    sums.assign(static_cast<std::size_t>(rows), 1);
    for (std::size_t k = 0; k < odds.size(); ++k) sums[row(k)] += odds[k] * to_rows[k];
  };
  for (int round = 0; round < kMessages; ++round) {
    sum_rows();
    for (std::size_t k = 0; k < odds.size(); ++k) to_columns[k] = odds[k] / std::max(1.0, sums[row(k)] - odds[k] * to_rows[k]);
    sums.assign(static_cast<std::size_t>(columns), 1);
    for (std::size_t k = 0; k < odds.size(); ++k) sums[column(k)] += to_columns[k];
    for (std::size_t k = 0; k < odds.size(); ++k) to_rows[k] = 1 / std::max(1.0, sums[column(k)] - to_columns[k]);
  }
  sum_rows();
  std::vector<double> probabilities;
  for (std::size_t k = 0; k < odds.size(); ++k) probabilities.push_back(odds[k] * to_rows[k] / sums[row(k)]);
  return probabilities;
}

}  // namespace marey::assign
