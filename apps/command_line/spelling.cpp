#include "spelling.h"

#include <algorithm>
#include <vector>

namespace marey::cli {

// The optimal string alignment distance, by rows.
int letters_apart(std::string_view a, std::string_view b) {
  std::vector<int> before(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
  for (std::size_t k = 0; k <= b.size(); ++k) above[k] = static_cast<int>(k);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = static_cast<int>(i);
    for (std::size_t k = 1; k <= b.size(); ++k) {
      row[k] = std::min({above[k] + 1, row[k - 1] + 1, above[k - 1] + (a[i - 1] == b[k - 1] ? 0 : 1)});
      const bool swapped = i > 1 && k > 1 && a[i - 1] == b[k - 2] && a[i - 2] == b[k - 1];
      if (swapped) row[k] = std::min(row[k], before[k - 2] + 1);
    }
    std::swap(before, above);
    std::swap(above, row);
  }
  return above[b.size()];
}

namespace {

/// This many slips are still a slip of the pen: a third of the letters, at most three.
int max_apart(std::string_view known) {
  const std::size_t dashes = std::min(known.find_first_not_of('-'), known.size());
  return std::clamp(static_cast<int>(known.size() - dashes) / 3, 1, 3);
}

}  // namespace

std::string suggestion(std::string_view word, std::span<const std::string> known) {
  const auto nearest = std::min_element(known.begin(), known.end(), [&](const std::string& a, const std::string& b) {
    return letters_apart(word, a) < letters_apart(word, b);
  });
  if (nearest == known.end() || letters_apart(word, *nearest) > max_apart(*nearest)) return {};
  return " Did you mean " + *nearest + "?";
}

}  // namespace marey::cli
