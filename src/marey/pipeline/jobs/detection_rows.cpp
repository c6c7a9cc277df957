#include "marey/pipeline/jobs/detection_rows.h"

#include <sstream>

#include "marey/detect/keypoints/model_folder.h"
#include "marey/filter/filters.h"
#include "marey/pipeline/people/track_in_image.h"

namespace marey::pipeline::jobs {
namespace {

std::vector<std::string> names_in(const std::string& list) {
  std::vector<std::string> names;
  std::istringstream words(list);
  for (std::string name; std::getline(words >> std::ws, name, ',');) names.push_back(name);
  return names;
}

}  // namespace

void add_people_rows(Table& table, PeopleDetection& detection) {
  table
      .choice("background", detection.background, names_in(detect::background::background_names()),
              "model of the static background")
      .checked(detect::background::parse_background);
  table.input_file("detector", detection.network,
                   "a detection network in addition to the background model: the file that describes it (docs/network.md)");
  table.whole("detector-interval", detection.every, "N", 1, 1000, "run the network on every N-th frame").depending_on({"detector"});
  table.flag("no-background", detection.without_background, "the network alone").depending_on({"detector"});
}

detect::DetectorOptions detector_of(const PeopleDetection& detection, bool keypoints, const std::string& needs_every_frame) {
  const bool skips = detection.every > 1;
  if (detection.network.empty() && !keypoints && (skips || detection.without_background))
    throw WrongOption("{} requires --detector", skips ? "--detector-interval" : "--no-background");
  if (detection.without_background && skips && !needs_every_frame.empty())
    throw WrongOption(
        "--detector-interval {} with --no-background: {} needs detections in every frame; omit one of the three options",
        detection.every, needs_every_frame);
  const detect::people::PeopleDetectorOptions people{.background = detect::background::parse_background(detection.background),
                                                     .people = {}};
  if (detection.network.empty() && !(keypoints && detection.without_background)) return people;
  detect::network::NetworkDetectorOptions network;
  network.model = detection.network.empty() ? detect::keypoints::model_file("person.toml") : detection.network;
  network.background = !detection.without_background;
  network.every = detection.every;
  network.score_factor = detection.score_factor;
  network.people = people;
  return network;
}

void check_model(const std::string& name) {
  if (name != "lite" && name != "full" && name != "heavy" && !name.ends_with(".onnx"))
    throw WrongOption("{}: is neither lite, full or heavy, nor a FILE.onnx", name);
}

void add_model_row(Table& table, std::string& model) {
  table
      .text("model", model,
            "the network that finds the points: lite, full or heavy, each slower and more accurate than the one before "
            "(script/model), or a FILE.onnx")
      .checked(check_model);
}

void add_threshold_row(Table& table, std::optional<double>& threshold) {
  table.number("threshold", threshold, "grey level", closed(0, 65535),
               "that the pixels of a marker exceed, 0 to 255 or 65535 (default: from the image noise)");
}

void add_blob_rows(Table& table, detect::markers::MarkerOptions& markers) {
  add_threshold_row(table, markers.threshold);
  table.flag("dark", markers.dark, "markers are darker than their surroundings");
  table.number("max-width", markers.widest, "px", closed(2, 200),
               "largest width of a marker; wider regions are removed from the image (default: only where they disturb)");
  table.whole("max-markers", markers.max_markers, "N", 1, 1'000'000,
              "per frame; beyond, those at predicted positions are kept, then the largest");
  table.number("min-area", markers.min_area, "px^2", closed(0, 1e8), "smallest marker, pixels that exceed the threshold");
  table.number("max-area", markers.max_area, "px^2", closed(0, 1e8), "largest marker, likewise");
  table.number("min-roundness", markers.min_roundness, "fraction", closed(0, 1),
               "area over that of the circle as long as the blob: 1 is a disc, an ellipse has the ratio of its axes");
}

void add_marker_rows(Table& table, MarkerDetection& detection) {
  add_blob_rows(table, detection.markers);
  table
      .text("colour", detection.colour,
            "markers of this hue, in degrees: 0 red, 60 yellow, 120 green, 180 cyan, 240 blue, 300 magenta; 120+-15 sets the "
            "tolerance")
      .checked(detect::markers::parse_marker_colour);
  table
      .number("saturation", detection.saturation, "fraction", closed(0.001, 0.999),
              "with --colour: minimum of (largest - smallest of red, green, blue), as a fraction of white (default: 0.2)")
      .depending_on({"colour"});
  table.input_file("mask", detection.mask, "an image of the video's size; what is not black in it is omitted");
  table.number("auto-mask", detection.markers.auto_mask_s, "s", closed(0, 3600),
               "omit what is bright and static in the first N seconds (lamps, reflections, and markers that do not move); 0: off");
}

detect::markers::MarkerOptions detector_of(const MarkerDetection& detection) {
  detect::markers::MarkerOptions markers = detection.markers;
  if (!detection.colour.empty()) {
    markers.colour = detect::markers::parse_marker_colour(detection.colour);
    markers.colour->min_saturation = detection.saturation.value_or(markers.colour->min_saturation);
  }
  if (!detection.mask.empty()) markers.mask = people::read_mask(detection.mask);
  return markers;
}

void add_number_row(Table& table, std::string& numbers) {
  table
      .output_file("numbers", numbers,
                   "each person's shirt number, read in the images, with its probability: FILE.csv; from when it is known it is in "
                   "overlays too (network: script/model --numbers)")
      .ending_in({".csv"});
}

void add_filter_row(Table& table, std::string& filter) {
  std::vector<std::string> names;
  for (const filter::NamedFilter& named : filter::named_filters()) names.emplace_back(named.name);
  table.choice("filter", filter, std::move(names), "motion model that predicts each person or marker")
      .checked(filter::filter_named);
}

}  // namespace marey::pipeline::jobs
