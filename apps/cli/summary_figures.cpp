#include "summary_figures.h"

#include <cstdio>

#include <fmt/core.h>

namespace marey::cli {

Json exclusions_of(const pipeline::corridor::Summary& summary) {
  Json json = Json::object();
  for (const pipeline::corridor::Exclusion& one : exclusions(summary)) json[std::string(one.key)] = one.count;
  return json;
}

double percent_of(std::int64_t part, std::int64_t whole) {
  return whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0;
}

void add_skeleton_figures(const pipeline::corridor::Summary& summary, Json& json) {
  if (!summary.skeleton || !summary.skeleton->rms_mm) return;
  json["skeleton"] = {{"rms_mm", *summary.skeleton->rms_mm}, {"initialisations", summary.skeleton->initialisations}};
}

void print_skeleton_figures(const pipeline::corridor::Summary& summary) {
  if (!summary.skeleton || !summary.skeleton->rms_mm) return;
  const std::int64_t lost = summary.skeleton->initialisations - 1;
  fmt::print(stderr, "skeleton: markers lie {:.1f} mm RMS from where it has them{}\n", *summary.skeleton->rms_mm,
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
