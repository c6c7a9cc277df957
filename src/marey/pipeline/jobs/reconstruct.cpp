#include "marey/pipeline/jobs/reconstruct.h"

#include "marey/core/keypoint_sets.h"
#include "marey/pipeline/jobs/track_image.h"

namespace marey::pipeline::jobs {
namespace {

void add_rate_row(Table& table, std::optional<double>& rate_hz) {
  table.number("rate", rate_hz, "Hz", kRates, "frame rate, if neither the sources nor the rig specify it");
}

}  // namespace

Table table_of(ReconstructMarkers& job) {
  markers::MarkersInSpaceOptions& how = job.options;
  Table table;
  add_name_rows(table, job.names);
  add_rate_row(table, how.rate_hz);
  table.number("noise", how.noise_px, "px", closed(1e-3, 100),
               "standard deviation of a blob's position and of the calibration (default: learned)");
  table.number("max-gap", how.fill_s, "s", closed(0, 10), "the longest gap that is filled");
  table
      .number("max-prediction", how.predict_s, "s", closed(0, 10),
              "write predictions for this duration of a longer gap; at most --max-gap")
      .depending_on({"max-gap"});
  table.flag("live", how.live, "write every instant at once, as marey live does: no gap is filled")
      .depending_on({"max-prediction"});
  table.number("marker-diameter", how.tracker.marker_width, "m", closed(1e-4, 1), "markers closer than this disturb each other");
  table.number("max-speed", how.tracker.max_speed, "m/s", closed(1e-3, 1e4), "the largest speed of a marker");
  add_blob_rows(table, how.markers);
  return table;
}

markers::MarkersInSpaceOptions resolved(const ReconstructMarkers& job, std::vector<std::string>& warnings) {
  markers::MarkersInSpaceOptions options = job.options;
  set_names(job.names, options, warnings);
  if (job.own_filter) options.tracker.filter = *job.own_filter;
  return options;
}

namespace {

void add_set_row(Table& table, std::string& set) {
  table
      .text("keypoint-set", set,
            "the keypoint set of files that do not name their points: " + keypoint_set_names() + " (default: by the points)")
      .checked([](const std::string& name) { keypoint_set_named(name); });
}

void add_video_rows(Table& table, std::string& model, PeopleDetection& detection) {
  table.group("Keypoints in videos");
  add_model_row(table, model);
  table.input_file("detector", detection.network,
                   "a detection network in place of the one for people: the file that describes it (docs/network.md)");
  table.flag("with-background", detection.without_background,
             "people are detected by what changes too, which is faster; default: by the network alone", false);
  table.whole("detector-interval", detection.every, "N", 1, 1000, "run the networks on every N-th frame");
}

keypoints::FindInImages find_by(const PeopleDetection& detection, const std::string& model) {
  return [detection, model](const RigCamera& camera, const Hooks& hooks) {
    TrackPeople search;
    search.keypoints = true;
    search.detection = detection;
    search.model = model;
    return people::find_keypoints(camera, resolved(search), hooks);
  };
}

}  // namespace

Table table_of(ReconstructKeypoints& job) {
  keypoints::KeypointsInSpaceOptions& how = job.options;
  Table table;
  table.always("targets", "keypoints");
  add_rate_row(table, how.rate_hz);
  table.group("Keypoints");
  add_set_row(table, how.set);
  table.whole("people", how.people, "N", 0, 1000, "keep the N people in the most images; 0: all");
  table.flag("no-smooth", how.smooth, "each instant by itself: no trajectories over all instants, no gap filled", false);
  table.flag("no-offsets", how.find_offsets,
             "cameras without an offset in the rig are taken as synchronous; default: offsets are found by the motion of people",
             false);
  table.number("max-offset", how.farthest_offset_s, "s", closed(0.01, 10), "the largest offset that is searched")
      .depending_on({"no-offsets"});
  add_video_rows(table, job.model, job.detection);
  return table;
}

Table table_of(CalibratePeople& job) {
  Table table;
  table.always("targets", "keypoints");
  add_rate_row(table, job.options.rate_hz);
  table.group("Keypoints");
  add_set_row(table, job.options.set);
  add_video_rows(table, job.model, job.detection);
  return table;
}

keypoints::KeypointsInSpaceOptions resolved(const ReconstructKeypoints& job) {
  keypoints::KeypointsInSpaceOptions options = job.options;
  options.find = find_by(job.detection, job.model);
  return options;
}

calibrate::CalibratePeopleOptions resolved(const CalibratePeople& job) {
  calibrate::CalibratePeopleOptions options = job.options;
  options.find = find_by(job.detection, job.model);
  options.live.detector = job.detection.network;
  return options;
}

}  // namespace marey::pipeline::jobs
