// `marey live` as a value: what live cameras observe, tracked while they do.
#pragma once

#include <string>
#include <vector>

#include "marey/pipeline/jobs/detection_rows.h"
#include "marey/pipeline/jobs/space_names.h"
#include "marey/pipeline/jobs/track_ground.h"
#include "marey/pipeline/live/live.h"

namespace marey::pipeline::jobs {

struct Live {
  std::string rig_name = {};  ///< for messages
  live::LiveTargets targets = live::LiveTargets::markers;
  bool ground = false;  ///< people, on the ground that the cameras face
  SpaceNames names = {};
  detect::markers::MarkerOptions markers = {};
  PeopleDetection detection = {};
  std::string numbers = {};    ///< a CSV file of people's shirt numbers (people/number_sink.h)
  std::string model = "lite";  ///< the network for keypoints
  int people = 0;              ///< who get keypoints in space; 0: all
  GroundPart part = {};
  double late_s = 0.05, patience_s = 3, preroll_s = 5;
};

Table table_of(Live& job);
/// Sinks, the take and everything that changes during the run are the front end's. Reads the files of names. Throws WrongOption for
/// options that exclude each other, Error if a file cannot be read.
live::LiveOptions resolved(const Live& job, const Rig& rig, std::vector<std::string>& warnings);

}  // namespace marey::pipeline::jobs
