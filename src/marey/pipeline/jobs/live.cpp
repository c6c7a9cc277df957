#include "marey/pipeline/jobs/live.h"

namespace marey::pipeline::jobs {

Table table_of(Live& job) {
  Table table;
  table.flag("ground", job.ground, "people on the ground that the rig's cameras face");
  add_ground_rows(table, job.part);
  table.number("preroll", job.preroll_s, "s", closed(0, 60), "kept from before a recording is switched on");
  table.number("frame-timeout", job.late_s, "s", closed(0.001, 1), "longest wait for a late frame of an instant");
  table.number("connect-timeout", job.patience_s, "s", closed(0, 60), "longest wait for cameras at the beginning");
  add_name_rows(table, job.names);
  add_blob_rows(table, job.markers);
  table.group("Options for --targets people");
  add_people_rows(table, job.detection);
  add_number_row(table, job.numbers);
  table.group("Options for --targets keypoints, in addition to --detector and --skeleton");
  add_model_row(table, job.model);
  table.whole("people", job.people, "N", 0, 1000, "of several cameras: track at most N people; 0: all");
  return table;
}

live::LiveOptions resolved(const Live& job, const Rig& rig, std::vector<std::string>& warnings) {
  live::LiveOptions options;
  if (!job.numbers.empty() && !job.ground && job.targets == live::LiveTargets::markers)
    throw WrongOption("--numbers {}: reads the shirts of people; add --targets people", job.numbers);
  if (job.ground && job.targets == live::LiveTargets::keypoints)
    throw WrongOption("{}",
                      "--ground localises people by their boxes, --targets keypoints by their body points; remove one of the two");
  options.targets = job.ground ? live::LiveTargets::people : job.targets;
  options.ground = job.ground;
  options.space.markers = options.markers.markers = job.markers;
  options.space.predict_s = 0.1;  // unswept
  set_names(job.names, options.space, warnings);
  const bool keypoints = options.targets == live::LiveTargets::keypoints;
  options.people.detector = detector_of(job.detection, keypoints, "");
  if (keypoints) options.people.keypoints = keypoints::KeypointOptions{.model = job.model, .every = job.detection.every};
  options.keypoints.model = job.model;
  options.keypoints.detector = job.detection.network;
  options.keypoints.people.maximum = job.people;
  options.people.live = true;
  TrackGround ground{.rig_name = job.rig_name, .detection = job.detection, .ground = job.part};
  ground.options.live = true;
  options.on_ground = resolved(ground, rig);
  options.policy.late_s = job.late_s;
  options.patience_s = job.patience_s;
  options.preroll_s = job.preroll_s;
  options.numbers = job.numbers;
  return options;
}

}  // namespace marey::pipeline::jobs
