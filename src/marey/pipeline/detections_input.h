#pragma once

#include <memory>
#include <optional>
#include <string>

#include "marey/core/source.h"
#include "marey/detect/detector.h"

namespace marey::pipeline {

/// What another program detected, in the place of a camera and a detector.
struct DetectionsInput {
  std::unique_ptr<Source> source;              ///< frames without pictures, from the first to the last that has a detection
  std::unique_ptr<detect::Detector> detector;  ///< answers each of them with the file's detections
};

/// Reads MOT text: `frame,-1,left,top,width,height,score,…`, `rate_hz` frames a second (25 where nothing is given, with a
/// warning). Scores in [0, 1] are taken as they are. Scores of another scale, or none of 0.5, are ranked: the weakest quarter may
/// continue a track, the others begin one too. Throws Error where the file cannot be read or a line is malformed.
DetectionsInput open_detections(const std::string& path, std::optional<double> rate_hz);

}  // namespace marey::pipeline
