#include "set_option.h"

#include <algorithm>
#include <cstdio>

#include <fmt/core.h>

#include "marey/core/error.h"
#include "marey/format/bodies/label_set_file.h"

#include "summary_figures.h"

namespace marey::cli {

void add_set_option(Command& command, std::string& set) {
  command.input_file("--set", set, "name the markers, frame by frame, by a set that \"marey label learn\" made: set.toml");
}

std::shared_ptr<const LearnedMarkers> learned_set_of(const std::string& path, const Skeleton* skeleton) {
  if (path.empty()) return nullptr;
  auto set = std::make_shared<const LearnedMarkers>(format::bodies::read_label_set(path));
  if (skeleton == nullptr) return set;
  const auto is_marker = [&](const std::string& label) {
    return std::any_of(skeleton->markers.begin(), skeleton->markers.end(),
                       [&](const SkeletonMarker& marker) { return marker.label == label; });
  };
  if (std::none_of(set->labels.begin(), set->labels.end(), is_marker))
    throw Error("{}: none of its names is a marker of the skeleton {}: the set has {} …, the skeleton {} …", path, skeleton->name,
                set->labels.front(), skeleton->markers.front().label);
  return set;
}

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
