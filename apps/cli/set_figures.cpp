#include "set_figures.h"

#include <cstdio>

#include <fmt/core.h>

#include "summary_figures.h"

namespace marey::cli {

void add_set_figures(const pipeline::corridor::Summary& summary, Json& json) {
  if (!summary.figures.contains("set_points")) return;
  json["set"] = {{"points", static_cast<std::int64_t>(figure_of(summary, "set_points"))},
                 {"named", static_cast<std::int64_t>(figure_of(summary, "set_named"))},
                 {"searched_s", figure_of(summary, "set_searched_s")}};
  json["set"]["found_at_s"] = summary.figures.contains("set_found_at_s") ? Json(figure_of(summary, "set_found_at_s")) : Json();
}

void print_set_figures(const pipeline::corridor::Summary& summary) {
  if (!summary.figures.contains("set_found_at_s")) return;
  const auto points = static_cast<std::int64_t>(figure_of(summary, "set_points"));
  fmt::print(stderr, "names: found at {:.2f} s; {:.2f} % of {} points since then have one of the set\n",
             figure_of(summary, "set_found_at_s"), percent_of(static_cast<std::int64_t>(figure_of(summary, "set_named")), points),
             points);
}

}  // namespace marey::cli
