#pragma once

#include <string>
#include <vector>

#include "marey/core/observation.h"
#include "marey/core/time.h"
#include "marey/detect/marker_detector.h"
#include "marey/simulate/marker_scene.h"

namespace marey {

/// Films a scene into an H.264 file, hardly compressed. Throws Error where it cannot be written.
void film_markers(const MarkerScene& scene, const std::string& path);

/// Writes the scene's truth as CSV, `frame,time,label,x,y,visible`, 0-based frames, s, px. Throws Error where it cannot be written.
void write_marker_truth(const MarkerScene& scene, const std::string& path);

/// What a detection of a marker is to a tracker.
Observation<2> observation_of(const Detection& detection);

/// What the detector finds in a video, frame by frame.
struct SeenMarkers {
  std::vector<Timestamp> times;
  std::vector<std::vector<Observation<2>>> frames;
};

/// Decodes a video and looks for markers in each frame. Throws Error where it cannot be read.
SeenMarkers see_markers(const std::string& path, const MarkerOptions& options = {});

}  // namespace marey
