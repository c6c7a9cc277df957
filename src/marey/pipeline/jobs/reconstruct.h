// `marey reconstruct` as a value: markers, or people's body keypoints, in space.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "marey/pipeline/calibrate/calibrate_people.h"
#include "marey/pipeline/jobs/detection_rows.h"
#include "marey/pipeline/jobs/space_names.h"
#include "marey/pipeline/keypoints/body_keypoints.h"
#include "marey/pipeline/keypoints/keypoints_in_space.h"
#include "marey/pipeline/markers/markers_in_space.h"

namespace marey::pipeline::jobs {

struct ReconstructMarkers {
  SpaceNames names = {};
  std::optional<filter::FilterOptions> own_filter = {};  ///< of a caller's, in place of the default one
  markers::MarkersInSpaceOptions options = {};           ///< rows without dependent defaults are bound to these
};

Table table_of(ReconstructMarkers& job);
/// Reads the files of names. Throws Error if one cannot be read.
markers::MarkersInSpaceOptions resolved(const ReconstructMarkers& job, std::vector<std::string>& warnings);

struct ReconstructKeypoints {
  /// How people are detected in cameras' videos: by a network alone unless the user wants the background too, because people who
  /// fill the image, or stand in it from the beginning, are typical here.
  PeopleDetection detection = {.without_background = true};
  std::string model = keypoints::KeypointOptions{}.model;
  keypoints::KeypointsInSpaceOptions options = {};
};

/// `marey calibrate people`: the same search. A person who is found late is missing in all cameras, so that half of the score
/// suffices: the landmark network rejects who is not a person, and geometry who is not in the other images.
struct CalibratePeople {
  PeopleDetection detection = {.without_background = true, .score_factor = 0.5};
  std::string model = keypoints::KeypointOptions{}.model;
  calibrate::CalibratePeopleOptions options = {};
};

Table table_of(CalibratePeople& job);
calibrate::CalibratePeopleOptions resolved(const CalibratePeople& job);

Table table_of(ReconstructKeypoints& job);
/// With the search in videos. It loads its networks when the first video is read.
keypoints::KeypointsInSpaceOptions resolved(const ReconstructKeypoints& job);

}  // namespace marey::pipeline::jobs
