#include "marker_options.h"

namespace marey::cli {

void add_marker_options(CLI::App& command, MarkerFlags& flags) {
  const auto group = "Options for --targets markers";
  command
      .add_option("--labels", flags.labels, "a text file with a name a line, for the markers of the first frame from left to right")
      ->group(group);
  command.add_option("--threshold", flags.threshold, "grey level that markers pass (default: told from the picture's noise)")
      ->group(group);
  command.add_flag("--dark", flags.dark, "markers are darker than what is around them")->group(group);
  command.add_option("--colour", flags.colour, "markers of this hue, in degrees: 120 is green; 120+-15 sets the tolerance")
      ->group(group);
  command
      .add_option("--saturation", flags.saturation,
                  "with --colour: least (largest - smallest of red, green, blue), as a share of white")
      ->check(CLI::Range(0.001, 0.999))
      ->group(group);
  command.add_option("--mask", flags.mask, "a picture of the video's size; what is not black in it is left out")->group(group);
  command
      .add_option("--auto-mask", flags.limits.auto_mask_s,
                  "leave out what is bright and does not move in the first so many seconds")
      ->check(CLI::NonNegativeNumber)
      ->group(group);
  command.add_option("--min-area", flags.limits.min_area, "smallest marker, in pixels above the threshold")
      ->capture_default_str()
      ->group(group);
  command.add_option("--max-area", flags.limits.max_area, "largest marker, likewise")->capture_default_str()->group(group);
  command.add_option("--min-roundness", flags.limits.min_roundness, "from 0, anything, to 1, a disc")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str()
      ->group(group);
  command.add_flag("--fit-noise", flags.fit_noise, "read how markers move, and how well they are seen, off the recording")
      ->group(group);
}

pipeline::TrackMarkersOptions marker_options(const MarkerFlags& flags, const std::string& filter, bool live) {
  pipeline::TrackMarkersOptions options;
  options.markers = flags.limits;
  options.markers.threshold = flags.threshold;
  options.markers.dark = flags.dark;
  if (!flags.colour.empty()) {
    options.markers.colour = detect::markers::parse_marker_colour(flags.colour);
    options.markers.colour->least_saturation = flags.saturation.value_or(options.markers.colour->least_saturation);
  }
  if (!flags.mask.empty()) options.markers.mask = pipeline::read_mask(flags.mask);
  if (!flags.labels.empty()) options.tracker.labels = pipeline::read_labels(flags.labels);
  if (!filter.empty()) options.tracker.filter = filter::filter_named(filter);
  options.fit_noise = flags.fit_noise;
  options.live = live;
  return options;
}

}  // namespace marey::cli
