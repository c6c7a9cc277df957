#include "marey/assign/k_best_assignments.h"

#include <algorithm>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace marey::assign {
namespace {

struct Whole {
  int problem;
  double gain;
  std::vector<int> columns;
};

/// Every answer to a problem, by trying all columns for each row.
void try_all(int problem, const AssignmentProblem& given, std::vector<int>& columns, double gain, std::vector<Whole>& found) {
  const int row = static_cast<int>(columns.size());
  if (row == given.rows) {
    found.push_back({problem, gain, columns});
    return;
  }
  columns.push_back(kNoIndex);
  try_all(problem, given, columns, gain, found);
  for (const GatedPair& pair : given.pairs) {
    if (pair.row != row || std::find(columns.begin(), columns.end(), pair.column) != columns.end()) continue;
    columns.back() = pair.column;
    try_all(problem, given, columns, gain + pair.gain, found);
  }
  columns.pop_back();
}

std::vector<GatedPair> random_pairs(std::mt19937& random, int rows, int columns, bool whole_numbers) {
  std::vector<GatedPair> pairs;
  const unsigned density = random() % 10 + 1;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      if (random() % 10 >= density) continue;
      const double gain = whole_numbers ? static_cast<double>(random() % 7) - 2 : static_cast<double>(random() % 100'000) / 1e4 - 3;
      pairs.push_back({row, column, gain});
    }
  }
  std::shuffle(pairs.begin(), pairs.end(), random);
  return pairs;
}

TEST(KBestAssigner, AsTryingAll) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  KBestAssigner assigner;
  for (int round = 0; round < 1000; ++round) {
    std::vector<std::vector<GatedPair>> pairs;
    std::vector<AssignmentProblem> problems;
    std::vector<Whole> all;
    const int count = static_cast<int>(random() % 3) + 1;
    pairs.reserve(count);
    for (int p = 0; p < count; ++p) {
      const int rows = static_cast<int>(random() % 5);
      const int columns = static_cast<int>(random() % 5);
      pairs.push_back(random_pairs(random, rows, columns, round % 2 == 0));
      problems.push_back({rows, columns, pairs.back(), static_cast<double>(random() % 4)});
      std::vector<int> chosen;
      try_all(p, problems.back(), chosen, problems.back().gain, all);
    }
    std::stable_sort(all.begin(), all.end(), [](const Whole& a, const Whole& b) { return a.gain > b.gain; });
    const int maximum = static_cast<int>(random() % 2 == 0 ? all.size() + 5 : random() % all.size() + 1);
    const double within = random() % 2 == 0 ? 1e9 : 3.5;
    const auto answers = assigner.find(problems, maximum, within);
    std::size_t expected = 0;
    while (expected < all.size() && static_cast<int>(expected) < maximum && all[expected].gain >= all[0].gain - within) ++expected;
    ASSERT_EQ(answers.size(), expected);
    std::set<std::pair<int, std::vector<int>>> different;
    for (std::size_t i = 0; i < answers.size(); ++i) {
      EXPECT_NEAR(answers[i].gain, all[i].gain, 1e-9);
      const std::vector<int> columns(answers[i].column_of_row.begin(), answers[i].column_of_row.end());
      EXPECT_TRUE(different.emplace(answers[i].problem, columns).second) << "the same answer twice";
      const auto same = std::find_if(all.begin(), all.end(),
                                     [&](const Whole& one) { return one.problem == answers[i].problem && one.columns == columns; });
      ASSERT_NE(same, all.end());
      EXPECT_NEAR(same->gain, answers[i].gain, 1e-9) << "a gain that is not that of its pairs";
    }
  }
}

TEST(KBestAssigner, TheFirstIsTheGatedAssignersAlsoWhereTheProblemIsLarge) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  KBestAssigner assigner;
  GatedAssigner one;
  for (int round = 0; round < 20; ++round) {
    const int rows = static_cast<int>(random() % 60) + 1;
    const int columns = static_cast<int>(random() % 60) + 1;
    const auto pairs = random_pairs(random, rows, columns, false);
    const AssignmentProblem problem{rows, columns, pairs};
    const auto answers = assigner.find({&problem, 1}, 30);
    const auto best = one.assign(rows, columns, pairs);
    double gain = 0;
    for (const GatedPair& pair : pairs) gain += best[pair.row] == pair.column ? pair.gain : 0;
    EXPECT_NEAR(answers[0].gain, gain, 1e-6);
    for (std::size_t i = 1; i < answers.size(); ++i) EXPECT_LE(answers[i].gain, answers[i - 1].gain + 1e-9);
  }
}

TEST(KBestAssigner, TheSameAgainWhateverTheOrderOfThePairs) {
  std::mt19937 random(7);
  KBestAssigner assigner;
  auto pairs = random_pairs(random, 6, 6, true);  // whole numbers: many draws
  const auto list = [&] {
    const AssignmentProblem problem{6, 6, pairs};
    std::vector<std::vector<int>> columns;
    for (const auto& answer : assigner.find({&problem, 1}, 100)) {
      columns.emplace_back(answer.column_of_row.begin(), answer.column_of_row.end());
    }
    return columns;
  };
  const auto first = list();
  std::shuffle(pairs.begin(), pairs.end(), random);
  EXPECT_EQ(list(), first);
}

TEST(KBestAssigner, NothingToAssign) {
  KBestAssigner assigner;
  EXPECT_TRUE(assigner.find({}, 5).empty());
  const AssignmentProblem lonely{2, 0, {}, 1.5};
  const auto answers = assigner.find({&lonely, 1}, 5);
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_EQ(answers[0].gain, 1.5);
  EXPECT_EQ(std::vector<int>(answers[0].column_of_row.begin(), answers[0].column_of_row.end()), std::vector<int>(2, -1));
}

}  // namespace
}  // namespace marey::assign
