// Tables as the pages of docs/ contain them: bench/figures.py compares the two.
#pragma once

#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace marey::experiments {

/// One line: the cells between bars.
inline std::string markdown_row(const std::vector<std::string>& cells) {
  return fmt::format("| {} |\n", fmt::join(cells, " | "));
}

/// The titles of the columns, and the line below them.
inline std::string markdown_header(const std::vector<std::string>& titles) {
  return markdown_row(titles) + markdown_row(std::vector<std::string>(titles.size(), "---"));
}

/// A figure with this many digits after the point, or a dash if it is missing.
template <typename Figure>
std::string markdown_figure(const Figure& figure, int digits) {
  if constexpr (requires { figure.has_value(); }) {
    return figure ? fmt::format("{:.{}f}", *figure, digits) : "–";
  } else {
    return fmt::format("{:.{}f}", figure, digits);
  }
}

}  // namespace marey::experiments
