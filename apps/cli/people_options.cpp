#include "people_options.h"

#include "marey/core/error.h"
#include "marey/detect/keypoints/model_folder.h"
#include "marey/filter/usual_motion.h"
#include "marey/geometry/bspline.h"

#include "command_line.h"

namespace marey::cli {
namespace {

constexpr int kMostControlPoints = 64, kMostLines = 512;

track::contour::OutlineOptions outline_options(const PeopleFlags& flags) {
  track::contour::OutlineOptions options;
  options.order = flags.order.value_or(options.order);
  options.lines = flags.lines.value_or(options.lines);
  options.control_points = flags.control_points;
  if (options.control_points && *options.control_points < options.order)
    throw WrongUsage("--control-points {}: a closed spline of order {} has {} to {} of them here", *options.control_points,
                     options.order, options.order, kMostControlPoints);
  return options;
}

}  // namespace

void add_people_options(Command& command, PeopleFlags& flags) {
  command.group("Options for --targets people");
  command.text("--background", flags.background, "the model of the empty scene, one of " + detect::background::background_names())
      .check(detect::background::parse_background);
  command.input_file("--detector", flags.detector,
                     "a detection network beside the background model: the file that describes it (docs/network.md)");
  command.whole("--every", flags.every, "N", 1, 1000, "run the network on every N-th frame");
  command.flag("--without-background", flags.without_background, "the network alone");
  const Option outline = command.flag("--outline", flags.outline, "follow each person's outline too: a closed spline");
  command
      .whole("--control-points", flags.control_points, "N", 3, kMostControlPoints,
             "of each outline (default: as many as its silhouette needs, at most 40)")
      .needs(outline);
  command.whole("--order", flags.order, "N", 2, geometry::SplineWeights::max_order, "of the spline, degree + 1 (default: 4, cubic)")
      .needs(outline);
  command
      .whole("--lines", flags.lines, "N", 1, kMostLines,
             "measurement lines across each outline, along which it is searched (default: 24)")
      .needs(outline);
  command.group("");
}

void add_keypoint_options(Command& command, PeopleFlags& flags) {
  command.group("Options for --targets keypoints");
  command
      .text("--model", flags.model,
            "the network that finds the points: lite, full or heavy, each slower and more accurate than the one before "
            "(script/model), or a FILE.onnx")
      .check([](const std::string& name) {
        if (name != "lite" && name != "full" && name != "heavy" && !name.ends_with(".onnx"))
          throw Error("{}: is none of lite, full, heavy, and no FILE.onnx", name);
      });
  command.group("");
}

void check_every(const PeopleFlags& flags, bool on_ground) {
  if (flags.detector.empty() && !flags.keypoints && (flags.every > 1 || flags.without_background))
    throw WrongUsage("{} requires --detector", flags.every > 1 ? "--every" : "--without-background");
  if (!flags.without_background || flags.every == 1 || !(flags.outline || on_ground)) return;
  throw WrongUsage("--every {} with --without-background: {} needs detections in every frame; leave out one of the three options",
                   flags.every, on_ground ? "--ground" : "--outline");
}

detect::DetectorOptions detector_options(const PeopleFlags& flags) {
  const detect::people::PeopleDetectorOptions people{.background = detect::background::parse_background(flags.background),
                                                     .people = {}};
  if (flags.detector.empty() && !(flags.keypoints && flags.without_background)) return people;
  detect::network::NetworkDetectorOptions network;
  network.model = flags.detector.empty() ? detect::keypoints::model_file("person.toml") : flags.detector;
  network.background = !flags.without_background;
  network.every = flags.every;
  network.people = people;
  return network;
}

pipeline::people::PeopleInPictureOptions people_options(const PeopleFlags& flags, const std::string& filter, bool live) {
  check_every(flags, false);
  pipeline::people::PeopleInPictureOptions options;
  options.detector = detector_options(flags);
  if (!filter.empty()) options.tracker.filter = filter::filter_for_people_in_picture(filter);
  if (flags.keypoints) options.keypoints = pipeline::keypoints::KeypointOptions{.model = flags.model, .every = flags.every};
  if (flags.outline) options.outlines = outline_options(flags);
  options.live = live;
  options.steady = flags.steady;
  return options;
}

}  // namespace marey::cli
