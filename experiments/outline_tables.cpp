// The figures of `marey experiment outlines` as text and in Markdown.
#include <iterator>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "experiments/markdown_table.h"
#include "experiments/outlines.h"

namespace marey::experiments {

std::string to_text(const OutlineExperiment& experiment) {
  std::string text;
  const auto number = [](const std::optional<double>& value, int digits) {
    return value ? fmt::format("{:.{}f}", *value, digits) : std::string("-");
  };
  for (std::size_t c = 0; c < experiment.cases.size(); ++c) {
    const OutlineCase& what = experiment.cases[c];
    fmt::format_to(std::back_inserter(text), "{}{}: {} {}, {} people; the true centres' jitter is {} px\n", c > 0 ? "\n" : "",
                   what.name, what.videos, what.videos == 1 ? "video" : "videos", what.people, number(what.true_jitter, 2));
    fmt::format_to(std::back_inserter(text), "{:<28}{:>8}{:>8}{:>8}{:>8}{:>12}{:>8}{:>12}{:>10}{:>8}{:>12}\n", "", "IoU", "alone",
                   "front", "behind", "centre, px", "lost", "followed", "jitter", "wild", "us a target");
    for (const auto& row : experiment.rows) {
      const OutlineScore& score = row.scores[c];
      fmt::format_to(std::back_inserter(text), "{:<28}{:>8.3f}{:>8}{:>8}{:>8}{:>12}{:>8}{:>11.1f}%{:>10}{:>8}{:>12}\n", row.method,
                     score.iou, number(score.alone, 3), number(score.front, 3), number(score.behind, 3),
                     number(score.centre_error, 2), score.lost, 100 * score.tracked, number(score.jitter, 2), score.wild,
                     number(score.target_us, 1));
    }
  }
  return text;
}

std::string to_markdown(const OutlineExperiment& experiment) {
  std::vector<std::string> titles{"", "videos", "people"};
  for (const auto& row : experiment.rows) titles.push_back(row.method);
  std::string text = markdown_header(titles);
  for (std::size_t c = 0; c < experiment.cases.size(); ++c) {
    const OutlineCase& what = experiment.cases[c];
    std::vector<std::string> cells{what.name, std::to_string(what.videos), std::to_string(what.people)};
    for (const auto& row : experiment.rows) {
      const OutlineScore& score = row.scores[c];
      cells.push_back(fmt::format("{:.2f} / {} / {}", score.iou, markdown_figure(score.centre_error, 2), score.lost));
    }
    text += markdown_row(cells);
  }
  return text;
}

}  // namespace marey::experiments
