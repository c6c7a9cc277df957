#include "marey/pipeline/jobs/track_image.h"

#include "marey/files/overwriting.h"
#include "marey/filter/default_motion.h"
#include "marey/geometry/bspline.h"

namespace marey::pipeline::jobs {
namespace {

constexpr int kMaxControlPoints = 64, kMaxLines = 512;

void add_image_rows(Table& table, ImageInput& input) {
  table.input_file("detections", input.camera.detections,
                   "in place of INPUT, detections: MOT text, frame,-1,left,top,width,height,score; of markers the output of marey "
                   "detect");
  table.number("rate", input.camera.rate_hz, "Hz", kRates, "frame rate, if the file does not specify it or is wrong");
  table.output_file("overlay", input.overlay, "a video with boxes, IDs and trails drawn into the images: FILE.mp4");
  table.output_file("plot", input.plot, "the trajectories as one image, in its coordinates: FILE.svg").ending_in({".svg"});
}

void add_blur_rows(Table& table, ImageInput& input) {
  table.choice("blur", input.blur, {"faces"},
               "make heads unrecognisable in --overlay and --copy: those of the people who are tracked");
  table.output_file("copy", input.copy, "the video again with nothing drawn and faces blurred: FILE.mp4").needing("blur");
}

void add_outline_rows(Table& table, TrackPeople& job) {
  table.flag("contour", job.outline, "track each person's outline too: a closed spline");
  table
      .whole("control-points", job.control_points, "N", 3, kMaxControlPoints,
             "of each outline (default: as many as its silhouette needs, at most 40)")
      .needing("contour");
  table
      .whole("spline-order", job.order, "N", 2, geometry::SplineWeights::max_order, "of the spline, degree + 1 (default: 4, cubic)")
      .needing("contour")
      .depending_on({"control-points"});
  table
      .whole("measurement-lines", job.lines, "N", 1, kMaxLines,
             "measurement lines across each outline, along which it is searched (default: 24)")
      .needing("contour");
  table
      .output_folder("target-masks", job.target_masks,
                     "a new folder for the pixels of each person's contour: target000001.png of the first frame, 16 bits, a "
                     "pixel's value is the number of the person that it shows")
      .needing("contour");
  table
      .text("contour-model", job.options.contour_model,
            "a network whose masks of people count as evidence beside colours: lite, full or heavy (script/model), or a FILE.onnx "
            "(default: none)")
      .checked(check_model)
      .needing("contour");
}

void add_keypoint_rows(Table& table, TrackPeople& job) {
  table.group("Options for --targets keypoints, in addition to those for people");
  add_model_row(table, job.model);
}

track::contour::OutlineOptions outlines_of(const TrackPeople& job) {
  track::contour::OutlineOptions options;
  options.order = job.order.value_or(options.order);
  options.lines = job.lines.value_or(options.lines);
  options.control_points = job.control_points;
  if (options.control_points && *options.control_points < options.order)
    throw WrongOption("--control-points {}: a closed spline of order {} has {} to {} of them here", *options.control_points,
                      options.order, options.order, kMaxControlPoints);
  return options;
}

void check(const ImageInput& input) {
  if (!input.overlay.empty() && !input.overlay.ends_with(".mp4") && !is_stream(input.overlay))
    throw WrongOption("--overlay {}: is an MP4 video; end its name in .mp4", input.overlay);
  if (!input.copy.empty() && !input.copy.ends_with(".mp4"))
    throw WrongOption("--copy {}: is an MP4 video; end its name in .mp4", input.copy);
  if (!input.blur.empty() && input.overlay.empty() && input.copy.empty())
    throw WrongOption("--blur {}: blurs in --overlay FILE.mp4 or --copy FILE.mp4; give one of them", input.blur);
}

void check(const TrackPeople& job) {
  check(job.input);
  if (job.delay && !job.options.live)
    throw WrongOption("--lag {}: is an option of --live; without it the whole recording is processed before output is written",
                      *job.delay);
  if (job.options.stabilise && !job.input.camera.detections.empty())
    throw WrongOption("{}", "--stabilise steadies images, and --detections has none; leave it out");
  if (!job.masks.empty() && job.detection.without_background)
    throw WrongOption("{}", "--foreground-masks shows the output of the background model; omit --no-background");
}

}  // namespace

Table table_of(TrackPeople& job) {
  Table table;
  if (job.keypoints) table.always("targets", "keypoints");
  add_image_rows(table, job.input);
  add_blur_rows(table, job.input);
  table.output_folder("foreground-masks", job.masks,
                      "a new folder for the output of the background model: bin000001.png of the first frame, white on black");
  add_filter_row(table, job.input.filter);
  table.flag("live", job.options.live, "write each frame's tracks at once; nothing is corrected by later frames");
  table
      .number("lag", job.delay, "s", closed(0, 60),
              "with --live: use the frames of this duration before each frame's tracks are written (default: 0)")
      .depending_on({"live"});
  table.flag("stabilise", job.options.stabilise,
             "the camera shakes (wind, steps): stabilise its images first; results are in the pixels of its rest");
  table.flag("measured-only", job.options.observed_only, "omit the rows of people who were not detected in that frame");
  table.group("Options for --targets people");
  add_people_rows(table, job.detection);
  add_number_row(table, job.numbers);
  add_outline_rows(table, job);
  if (job.keypoints) add_keypoint_rows(table, job);
  return table;
}

people::ImagePeopleOptions resolved(const TrackPeople& job) {
  check(job);
  people::ImagePeopleOptions options = job.options;
  options.detector = detector_of(job.detection, job.keypoints, job.outline ? "--contour" : "");
  if (!job.input.filter.empty()) options.tracker.filter = filter::filter_for_people_in_image(job.input.filter);
  if (job.input.own_filter) options.tracker.filter = *job.input.own_filter;
  if (job.keypoints) options.keypoints = keypoints::KeypointOptions{.model = job.model, .every = job.detection.every};
  if (job.outline) options.outlines = outlines_of(job);
  options.delay = job.delay.value_or(0);
  return options;
}

Table table_of(TrackMarkers& job) {
  Table table;
  table.always("targets", "markers");
  add_image_rows(table, job.input);
  add_filter_row(table, job.input.filter);
  table.flag("live", job.options.live, "write each frame's tracks at once; nothing is corrected by later frames");
  table.group("Options for --targets markers");
  table.input_file("labels", job.labels,
                   "a text file with one label per line, for the markers of the first frame from left to right");
  add_marker_rows(table, job.detection);
  table.flag("estimate-noise", job.options.fit_noise, "estimate process and measurement noise from the recording");
  return table;
}

markers::ImageMarkerOptions resolved(const TrackMarkers& job) {
  check(job.input);
  markers::ImageMarkerOptions options = job.options;
  options.markers = detector_of(job.detection);
  if (!job.labels.empty()) options.tracker.labels = people::read_labels(job.labels);
  if (!job.input.filter.empty()) options.tracker.filter = filter::filter_named(job.input.filter);
  if (job.input.own_filter) options.tracker.filter = *job.input.own_filter;
  return options;
}

}  // namespace marey::pipeline::jobs
