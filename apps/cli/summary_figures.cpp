#include "summary_figures.h"

#include <cstdio>

#include <fmt/core.h>

namespace marey::cli {

double figure_of(const pipeline::corridor::Summary& summary, std::string_view name) {
  const auto found = summary.figures.find(name);
  return found != summary.figures.end() ? found->second : 0;
}

std::int64_t excluded_of(const pipeline::corridor::Summary& summary, std::string_view reason) {
  const auto found = summary.excluded.find(reason);
  return found != summary.excluded.end() ? found->second : 0;
}

double percent_of(std::int64_t part, std::int64_t whole) {
  return whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0;
}

void add_skeleton_figures(const pipeline::corridor::Summary& summary, Json& json) {
  if (!summary.figures.contains("skeleton_rms_mm")) return;
  json["skeleton"] = {{"rms_mm", figure_of(summary, "skeleton_rms_mm")},
                      {"starts", static_cast<std::int64_t>(figure_of(summary, "skeleton_starts"))}};
}

void print_skeleton_figures(const pipeline::corridor::Summary& summary) {
  if (!summary.figures.contains("skeleton_rms_mm")) return;
  const auto lost = static_cast<std::int64_t>(figure_of(summary, "skeleton_starts")) - 1;
  fmt::print(stderr, "skeleton: markers lie {:.1f} mm RMS from where it has them{}\n", figure_of(summary, "skeleton_rms_mm"),
             lost > 0 ? fmt::format("; lost and found again {} times", lost) : "");
}

Json stages_of(const pipeline::corridor::Summary& summary) {
  Json stages;
  for (const pipeline::corridor::Summary::StepTime& step : summary.steps)
    stages[step.name] = {{"count", step.count}, {"median_ms", 1000 * step.median}, {"p99_ms", 1000 * step.p99}};
  return stages;
}

void print_stages(const pipeline::corridor::Summary& summary) {
  for (const pipeline::corridor::Summary::StepTime& step : summary.steps)
    fmt::print(stderr, "  {:<18} median {:8.3f} ms, 99 % within {:8.3f} ms\n", step.name, 1000 * step.median, 1000 * step.p99);
}

}  // namespace marey::cli
