#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "marey/pipeline/people_eyes.h"
#include "marey/pipeline/run.h"
#include "marey/track/contour/outline_follower.h"
#include "marey/track/join.h"
#include "marey/track/tracker.h"

namespace marey::pipeline {

struct TrackPeopleOptions {
  detect::background::BackgroundOptions background;
  detect::people::PeopleOptions people;
  track::TrackerOptions tracker;
  track::JoinOptions join;
  std::optional<track::contour::OutlineOptions> outlines;  ///< follow outlines too, with these; pictures are needed for it
  /// Every frame's tracks are written as they come: nothing is read ahead and nothing improved by what came later.
  bool live = false;
};

struct TrackSummary {
  std::int64_t frames = 0;
  double seconds = 0;           ///< from the first frame to the last
  std::int64_t people = 0;      ///< distinct numbers
  std::int64_t rows = 0;        ///< people times the frames they are in
  std::int64_t detections = 0;  ///< handed to the tracker
  std::int64_t outlines = 0;    ///< rows that have an outline
  std::int64_t held = 0;        ///< outlines of which too little was seen, so that they moved on with their shape held
  // What was dropped, and why.
  std::int64_t noise = 0;      ///< regions too small to be a part of a person
  std::int64_t misfits = 0;    ///< regions that no body explains: cars, swaying trees, lights
  std::int64_t too_brief = 0;  ///< targets not seen for long enough to be believed

  bool stopped = false;               ///< before the end, because a hook said so
  std::vector<std::string> warnings;  ///< what went wrong without stopping the run, one sentence each
};

/// Follows people through a recording and writes where they were. The only place that knows the order of the steps: source,
/// detector (told where people are expected), tracker, second pass over the whole recording, files. Memory grows with the number of
/// rows, 64 bytes each, and with nothing else; not even with those where `live`. Outlines wait for the
/// second pass on disk. The same input gives the same output, bit for bit.
/// Throws Error where the input cannot be read at all, or an output not written; nothing half-written stays behind.
TrackSummary track_people(const PeopleInput& input, const TrackOutput& output, const TrackPeopleOptions& options = {},
                          const RunHooks& hooks = {});

}  // namespace marey::pipeline
