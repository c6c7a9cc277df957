#include "set_figures.h"

#include <cstdio>

#include <fmt/core.h>

#include "summary_figures.h"

namespace marey::cli {

void add_set_figures(const pipeline::corridor::Summary& summary, Json& json) {
  if (!summary.marker_set) return;
  const pipeline::corridor::MarkerSetFigures& set = *summary.marker_set;
  json["set"] = {{"points", set.points},
                 {"named", set.named},
                 {"searched_s", set.searched_s},
                 {"found_at_s", set.found_at_s ? Json(*set.found_at_s) : Json()}};
}

void print_set_figures(const pipeline::corridor::Summary& summary) {
  if (!summary.marker_set || !summary.marker_set->found_at_s) return;
  const pipeline::corridor::MarkerSetFigures& set = *summary.marker_set;
  fmt::print(stderr, "names: found at {:.2f} s; {:.2f} % of {} points since then have one of the set\n", *set.found_at_s,
             percent_of(set.named, set.points), set.points);
}

}  // namespace marey::cli
