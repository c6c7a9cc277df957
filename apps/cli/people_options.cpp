#include "people_options.h"

#include "marey/core/error.h"
#include "marey/geometry/bspline.h"

#include "known.h"

namespace marey::cli {
namespace {

/// The filters' own parameters are in pixels, for things that move as people do who are this high.
constexpr double kBodyHeight = 100;

constexpr int kMostControlPoints = 64, kMostLines = 512;

track::contour::OutlineOptions outline_options(const PeopleFlags& flags) {
  track::contour::OutlineOptions options;
  options.order = flags.order.value_or(options.order);
  options.lines = flags.lines.value_or(options.lines);
  options.control_points = flags.control_points;
  if (options.order < 2 || options.order > geometry::SplineWeights::max_order) {
    throw Error("--order {}: a spline's order is its degree + 1; give 2 to {}, 4 for a cubic", options.order,
                geometry::SplineWeights::max_order);
  }
  if (options.lines < 1 || options.lines > kMostLines) {
    throw Error("--lines {}: an outline is searched along 1 to {} measurement lines", options.lines, kMostLines);
  }
  const int least = std::max(3, options.order);
  if (options.control_points && (*options.control_points < least || *options.control_points > kMostControlPoints)) {
    throw Error("--control-points {}: a closed spline of order {} has {} to {} of them here", *options.control_points,
                options.order, least, kMostControlPoints);
  }
  return options;
}

}  // namespace

void add_people_options(CLI::App& command, PeopleFlags& flags) {
  const auto group = "Options for --targets people";
  command
      .add_option("--background", flags.background,
                  "the model of the empty scene, one of " + detect::background::background_names())
      ->check(known([](const std::string& text) { detect::background::parse_background(text); }))
      ->group(group);
  auto* outline = command.add_flag("--outline", flags.outline, "follow each person's outline too: a closed spline")->group(group);
  command
      .add_option("--control-points", flags.control_points,
                  "of each outline (default: as many as its silhouette needs, at most 24)")
      ->needs(outline)
      ->group(group);
  command.add_option("--order", flags.order, "of the spline, degree + 1 (default: 4, cubic)")->needs(outline)->group(group);
  command.add_option("--lines", flags.lines, "measurement lines across each outline, along which it is searched (default: 24)")
      ->needs(outline)
      ->group(group);
}

pipeline::TrackPeopleOptions people_options(const PeopleFlags& flags, const std::string& filter, bool live) {
  pipeline::TrackPeopleOptions options;
  options.background = detect::background::parse_background(flags.background);
  if (!filter.empty() && filter::filter_named(filter).index() != options.tracker.filter.index()) {
    options.tracker.filter = filter::scaled(filter::filter_named(filter), 1 / kBodyHeight);
  }
  if (flags.outline) options.outlines = outline_options(flags);
  options.live = live;
  return options;
}

}  // namespace marey::cli
