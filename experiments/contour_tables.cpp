// The figures of `marey experiment contours` as text and in Markdown.
#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "experiments/contours.h"
#include "experiments/markdown_table.h"

namespace marey::experiments {

std::string to_text(const ContourExperiment& experiment) {
  std::size_t widest = 0;
  for (const ContourRow& row : experiment.rows) widest = std::max(widest, row.name.size());
  std::string text = fmt::format("{:<{}}", "", widest + 2);
  for (const char* method : kContourMethods) fmt::format_to(std::back_inserter(text), "{:>13}", method);
  fmt::format_to(std::back_inserter(text), "{:>10}{:>9}\n", "must", "samples");
  for (const ContourRow& row : experiment.rows) {
    fmt::format_to(std::back_inserter(text), "{:<{}}", row.name, widest + 2);
    for (const auto& value : row.values) fmt::format_to(std::back_inserter(text), "{:>13}", markdown_figure(value, row.digits));
    fmt::format_to(std::back_inserter(text), "{:>10}{:>9}\n", row.must, row.samples);
  }
  return text;
}

std::string to_markdown(const ContourExperiment& experiment) {
  std::vector<std::string> titles{""};
  titles.insert(titles.end(), kContourMethods.begin(), kContourMethods.end());
  titles.emplace_back("must");
  titles.emplace_back("samples");
  std::string text = markdown_header(titles);
  for (const ContourRow& row : experiment.rows) {
    if (row.is_time) continue;
    std::vector<std::string> cells{row.name};
    for (const auto& value : row.values) cells.push_back(markdown_figure(value, row.digits));
    cells.push_back(row.must);
    cells.push_back(std::to_string(row.samples));
    text += markdown_row(cells);
  }
  return text;
}

}  // namespace marey::experiments
