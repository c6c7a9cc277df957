#pragma once

#include <memory>
#include <optional>
#include <string>

#include "marey/core/source.h"
#include "marey/detect/background/background.h"
#include "marey/detect/people/people.h"

namespace marey::pipeline {

/// Where people are looked for: in pictures, or in what another program detected. One of the two paths is given.
struct PeopleInput {
  std::string pictures = {};            ///< a video file, a folder of pictures or a pattern of their names
  std::string detections = {};          ///< MOT text
  std::optional<double> rate_hz = {};   ///< frames a second, in place of what the pictures' header says
  std::optional<cv::Rect> region = {};  ///< px; the part of the pictures that is looked at, whose corner pixels then count from
};

/// Where frames come from, and what finds people in them.
struct DetectionStage {
  std::unique_ptr<Source> source;                          ///< pictures are decoded ahead, on a thread of its own
  std::unique_ptr<detect::Detector> detector;              ///< `prime` was called, where it was asked for
  const detect::people::PeopleDetector* people = nullptr;  ///< the same detector, where it is Marey's own
};

struct DetectionStageOptions {
  detect::background::BackgroundOptions background = {};
  detect::people::PeopleOptions people = {};
  bool read_ahead = true;  ///< look at pictures of the beginning first, to learn the empty scene; a live camera cannot
};

/// The input's pictures, opened. Throws Error where they cannot be read.
std::unique_ptr<Source> open_pictures(const PeopleInput& input);

/// Opens the input. Throws Error where it cannot be read.
DetectionStage open_detection_stage(const PeopleInput& input, const DetectionStageOptions& options);

}  // namespace marey::pipeline
