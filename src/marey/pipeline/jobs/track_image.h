// `marey track` of one camera as a value: people, people with body points, or markers.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "marey/pipeline/jobs/detection_rows.h"
#include "marey/pipeline/people/track_in_image.h"

namespace marey::pipeline::jobs {

/// What both jobs of one camera have.
struct ImageInput {
  RigCamera camera;                                      ///< `source` is the front end's
  std::string overlay, plot;                             ///< files of graphics; empty: none
  std::string blur, copy;                                ///< "faces"; a video with faces blurred and nothing drawn; empty: none
  std::string filter;                                    ///< by name; empty: the default one
  std::optional<filter::FilterOptions> own_filter = {};  ///< of a caller's, in place of a named one
};

struct TrackPeople {
  bool keypoints = false;  ///< body points too: another job with a few options more
  ImageInput input = {};
  PeopleDetection detection = {};
  std::string model = keypoints::KeypointOptions{}.model;
  bool outline = false;
  std::optional<int> control_points = {}, order = {}, lines = {};
  std::optional<double> delay = {};
  std::string numbers = {};                 ///< a CSV file; empty: none
  std::string target_masks = {};            ///< a folder; empty: none
  std::string masks = {};                   ///< a folder; empty: none
  people::ImagePeopleOptions options = {};  ///< rows without dependent defaults are bound to these
};

Table table_of(TrackPeople& job);
/// Throws WrongOption for options that exclude each other.
people::ImagePeopleOptions resolved(const TrackPeople& job);

struct TrackMarkers {
  ImageInput input = {};
  MarkerDetection detection = {};
  std::string labels = {};
  markers::ImageMarkerOptions options = {};
};

Table table_of(TrackMarkers& job);
/// Reads the files of labels and of the mask. Throws Error if one cannot be read.
markers::ImageMarkerOptions resolved(const TrackMarkers& job);

}  // namespace marey::pipeline::jobs
