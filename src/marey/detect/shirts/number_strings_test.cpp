#include "marey/detect/shirts/number_strings.h"

#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace marey::detect::shirts {
namespace {

using Column = std::array<double, kColumnClasses>;

/// What an alignment, a class for each column, spells: equal neighbours are one, blanks go. Nothing if it has more than two digits.
std::optional<int> spelled(const std::vector<int>& alignment) {
  std::vector<int> digits;
  for (std::size_t t = 0; t < alignment.size(); ++t) {
    if (alignment[t] != 0 && (t == 0 || alignment[t] != alignment[t - 1])) digits.push_back(alignment[t] - 1);
  }
  if (digits.size() > 2) return std::nullopt;
  if (digits.empty()) return 0;
  return digits.size() == 1 ? string_index(-1, digits[0]) : string_index(digits[0], digits[1]);
}

TEST(NumberStrings, NamesEveryIndex) {
  EXPECT_EQ(string_at(0), "");
  EXPECT_EQ(string_at(string_index(-1, 7)), "7");
  EXPECT_EQ(string_at(string_index(0, 7)), "07");
  EXPECT_EQ(string_at(string_index(9, 9)), "99");
  EXPECT_EQ(string_index(9, 9), kStrings - 1);
}

TEST(NumberStrings, SumsOverAllAlignments) {
  std::minstd_rand random(3);
  for (int round = 0; round < 3; ++round) {
    std::vector<Column> columns(4);
    for (Column& column : columns) {
      for (double& probability : column) probability = static_cast<double>(random() % 1000) / 5000;
    }
    StringProbabilities expected{};
    std::vector<int> alignment(columns.size());
    for (int code = 0; code < kColumnClasses * kColumnClasses * kColumnClasses * kColumnClasses; ++code) {
      double likelihood = 1;
      for (std::size_t t = 0, rest = static_cast<std::size_t>(code); t < columns.size(); ++t, rest /= kColumnClasses) {
        alignment[t] = static_cast<int>(rest % kColumnClasses);
        likelihood *= columns[t][static_cast<std::size_t>(alignment[t])];
      }
      if (const auto index = spelled(alignment)) expected[static_cast<std::size_t>(*index)] += likelihood;
    }
    const StringProbabilities found = string_likelihoods(columns);
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-12) << string_at(static_cast<int>(i));
  }
}

TEST(NumberStrings, NeedsABlankBetweenEqualDigits) {
  Column one{}, blank{};
  one[2] = 1;
  blank[0] = 1;
  EXPECT_EQ(string_likelihoods(std::vector{one, one})[static_cast<std::size_t>(string_index(1, 1))], 0);
  EXPECT_EQ(string_likelihoods(std::vector{one, blank, one})[static_cast<std::size_t>(string_index(1, 1))], 1);
}

}  // namespace
}  // namespace marey::detect::shirts
