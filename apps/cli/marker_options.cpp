#include "marker_options.h"

#include "marey/pipeline/people/track_in_picture.h"

#include "blob_options.h"
#include "command_line.h"

namespace marey::cli {

void add_detector_options(Command& command, MarkerFlags& flags) {
  add_blob_options(command, flags.limits);
  command.text("--colour", flags.colour, "markers of this hue, in degrees: 120 is green; 120+-15 sets the tolerance")
      .check(detect::markers::parse_marker_colour);
  command.number("--saturation", flags.saturation, "share", closed(0.001, 0.999),
                 "with --colour: least (largest - smallest of red, green, blue), of white");
  command.input_file("--mask", flags.mask, "a picture of the video's size; what is not black in it is left out");
  command.number("--auto-mask", flags.limits.auto_mask_s, "s", closed(0, 3600),
                 "leave out what is bright and does not move in the first so many seconds");
}

void add_marker_options(Command& command, MarkerFlags& flags) {
  command.group("Options for --targets markers");
  command.input_file("--labels", flags.labels,
                     "a text file with a name a line, for the markers of the first frame from left to right");
  add_detector_options(command, flags);
  command.flag("--fit-noise", flags.fit_noise, "read how markers move, and how well they are seen, off the recording");
  command.group("");
}

detect::markers::MarkerOptions detector_options(const MarkerFlags& flags) {
  detect::markers::MarkerOptions options = flags.limits;
  if (!flags.colour.empty()) {
    options.colour = detect::markers::parse_marker_colour(flags.colour);
    options.colour->least_saturation = flags.saturation.value_or(options.colour->least_saturation);
  }
  if (!flags.mask.empty()) options.mask = pipeline::people::read_mask(flags.mask);
  return options;
}

pipeline::markers::MarkersInPictureOptions marker_options(const MarkerFlags& flags, const std::string& filter, bool live) {
  pipeline::markers::MarkersInPictureOptions options;
  options.markers = detector_options(flags);
  if (!flags.labels.empty()) options.tracker.labels = pipeline::people::read_labels(flags.labels);
  if (!filter.empty()) options.tracker.filter = filter::filter_named(filter);
  options.fit_noise = flags.fit_noise;
  options.live = live;
  return options;
}

}  // namespace marey::cli
