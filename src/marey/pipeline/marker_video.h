#pragma once

#include <string>
#include <vector>

#include "marey/core/observation.h"
#include "marey/core/time.h"
#include "marey/detect/markers/marker_detector.h"
#include "marey/simulate/markers/marker_scene.h"

namespace marey::pipeline {

/// Films a scene into an H.264 file, hardly compressed. Throws Error where it cannot be written.
void film_markers(const simulate::markers::MarkerScene& scene, const std::string& path);

/// Writes the scene's truth as CSV, `frame,time,label,x,y,visible`, 0-based frames, s, px. Throws Error where it cannot be written.
void write_marker_truth(const simulate::markers::MarkerScene& scene, const std::string& path);

/// What a detection of a marker is to a tracker.
Observation<2> observation_of(const Detection& detection);

/// What the detector finds in a video, frame by frame.
struct SeenMarkers {
  std::vector<Timestamp> times;
  std::vector<std::vector<Observation<2>>> frames;
};

/// Decodes a video and looks for markers in each frame. Throws Error where it cannot be read.
SeenMarkers see_markers(const std::string& path, const detect::markers::MarkerOptions& options = {});

}  // namespace marey::pipeline
