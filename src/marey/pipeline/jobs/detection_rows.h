// The options of detectors, which several jobs share.
#pragma once

#include <string>

#include "marey/detect/detectors.h"
#include "marey/pipeline/jobs/option.h"

namespace marey::pipeline::jobs {

/// How people are detected in images.
struct PeopleDetection {
  std::string background = std::string(detect::background::AdaptiveOptions::name);
  std::string network = {};  ///< the file that describes it; empty: none
  bool without_background = false;
  int every = 1;
  double score_factor = 1;  ///< times the least score that the network's file names
};

/// --background, --detector, --detector-interval, --no-background.
void add_people_rows(Table& table, PeopleDetection& detection);

/// `keypoints`: body points are searched too, which brings a detection network of its own. `needs_every_frame`: the option that
/// needs detections in each frame, empty if absent. Throws WrongOption for options that exclude each other.
detect::DetectorOptions detector_of(const PeopleDetection& detection, bool keypoints, const std::string& needs_every_frame);

/// Throws WrongOption unless this names a landmark network: lite, full, heavy or a FILE.onnx.
void check_model(const std::string& name);
/// --model: the network that finds body points.
void add_model_row(Table& table, std::string& model);

/// --threshold.
void add_threshold_row(Table& table, std::optional<double>& threshold);
/// --threshold, --dark, and the limits of a blob's size and shape.
void add_blob_rows(Table& table, detect::markers::MarkerOptions& markers);

/// What a detector of markers in images of one camera has besides.
struct MarkerDetection {
  detect::markers::MarkerOptions markers;
  std::string colour, mask;
  std::optional<double> saturation;
};

/// The blobs, --colour, --saturation, --mask and --auto-mask.
void add_marker_rows(Table& table, MarkerDetection& detection);
/// Reads the mask. Throws Error if it cannot be read.
detect::markers::MarkerOptions detector_of(const MarkerDetection& detection);

/// --numbers: a file for the numbers of people's shirts.
void add_number_row(Table& table, std::string& numbers);

/// --filter.
void add_filter_row(Table& table, std::string& filter);

}  // namespace marey::pipeline::jobs
