// The jobs, each from Python's options to the pipeline's.
#include <algorithm>
#include <filesystem>

#include <tbb/global_control.h>

#include "marey/core/error.h"
#include "marey/files/source_name.h"
#include "marey/format/rig/rig_ptz.h"
#include "marey/pipeline/jobs/augment.h"
#include "marey/pipeline/jobs/live.h"
#include "marey/pipeline/jobs/reconstruct.h"
#include "marey/pipeline/jobs/register.h"
#include "marey/pipeline/jobs/solve.h"
#include "marey/pipeline/jobs/track_ground.h"
#include "marey/pipeline/jobs/track_image.h"
#include "marey/pipeline/live/live_feeds.h"
#include "marey/pipeline/markers/reconstruct.h"
#include "marey/source/live/phone.h"

#include "job.h"

namespace marey::python {
namespace {

/// What one camera saw: a path, frames of Python's, or another program's detections; a detector of Python's, if there is one.
void set_feed(pipeline::people::ImageFeed& feed, const Options& options) {
  feed.camera.source = options.get<std::string>("source", {});
  if (const auto frames = options.object("frames")) feed.how.open = [frames] { return open_frames(frames); };
  feed.how.opens_again = options.get("frames_again", false);
  if (const auto detector = options.object("detector")) feed.detector = [detector] { return detector_of(detector); };
}

std::optional<filter::FilterOptions> own_filter(const Options& options) {
  const auto own = options.object("own_filter");
  return own != nullptr ? std::optional<filter::FilterOptions>(filter_of(own)) : std::nullopt;
}

/// `run(feed, output, sinks, hooks)` over the feed of Python.
template <typename Run>
nb::tuple in_image(const Options& options, const pipeline::jobs::ImageInput& input, const Rows& rows, Run run) {
  pipeline::people::ImageFeed feed{.camera = input.camera};
  set_feed(feed, options);
  const Outputs outputs(options, format::Content::image, {&feed.camera, 1}, &rows);
  const pipeline::people::TrackOutput output{
      .tracks = {}, .overlay = input.overlay, .copy = input.copy, .blur_faces = !input.blur.empty(), .plot = input.plot};
  return tuple_of(run_job(rows.listening(options), [&](const Hooks& hooks) {
    Result result;
    result.summary = run(feed, output, outputs.open(result.recording), hooks);
    return result;
  }));
}

nb::tuple track_people(nb::dict given) {
  const Options options(std::move(given));
  pipeline::jobs::TrackPeople job{.keypoints = options.get("keypoints", false)};
  const Rows rows(table_of(job), options);
  job.input.own_filter = own_filter(options);
  pipeline::people::ImagePeopleOptions how = rows.resolved([&] { return resolved(job); });
  how.spill_path = (std::filesystem::temp_directory_path() / "marey").string();
  return in_image(options, job.input, rows, [&](const auto& feed, auto output, auto sinks, const Hooks& hooks) {
    output.masks = job.masks;
    output.target_masks = job.target_masks;
    output.numbers = job.numbers;
    return pipeline::people::track_people(feed, output, std::move(sinks), how, hooks);
  });
}

nb::tuple track_markers(nb::dict given) {
  const Options options(std::move(given));
  pipeline::jobs::TrackMarkers job;
  const Rows rows(table_of(job), options);
  job.input.own_filter = own_filter(options);
  pipeline::markers::ImageMarkerOptions how = rows.resolved([&] { return resolved(job); });
  if (const auto names = options.find<std::vector<std::string>>("label_names")) how.tracker.labels = *names;
  return in_image(options, job.input, rows, [&](const auto& feed, const auto& output, auto sinks, const Hooks& hooks) {
    return pipeline::people::track_markers(feed, output, std::move(sinks), how, hooks);
  });
}

nb::tuple track_ground(nb::dict given) {
  const Options options(std::move(given));
  const Rig rig = rig_of(options);
  pipeline::jobs::TrackGround job{.rig_name = options.get<std::string>("rig", "the rig")};
  const Rows rows(table_of(job), options);
  job.own_filter = own_filter(options);
  pipeline::people::ground::PeopleOnGroundOptions how = rows.resolved([&] { return resolved(job, rig); });
  if (const auto path = options.path("rig"); !path.empty()) how.ptz = format::rig::read_ptz(path);
  const Outputs outputs(options, format::Content::ground, rig.cameras, &rows,
                        pipeline::people::ground::overlays_of(rig, job.output));
  return tuple_of(run_job(rows.listening(options), [&](const Hooks& hooks) {
    Result result;
    result.summary = pipeline::people::ground::track_ground(rig, job.output, outputs.open(result.recording), how, hooks);
    return result;
  }));
}

nb::tuple reconstruct(nb::dict given) {
  const Options options(std::move(given));
  const Rig rig = rig_of(options);
  pipeline::jobs::ReconstructMarkers job;
  const Rows rows(table_of(job), options);
  job.own_filter = own_filter(options);
  std::vector<std::string> warnings;
  const pipeline::markers::MarkersInSpaceOptions how = rows.resolved([&] { return resolved(job, warnings); });
  const auto observations = options.get<std::string>("observations", {});
  const Outputs outputs(options, format::Content::space, rig.cameras, &rows);
  return tuple_of(run_job(rows.listening(options), [&](const Hooks& hooks) {
    Result result;
    pipeline::corridor::Sinks sinks;
    outputs.add_to(sinks, result.recording);
    result.summary = pipeline::markers::reconstruct(rig, observations, sinks, how, hooks);
    result.summary.warnings.insert(result.summary.warnings.begin(), warnings.begin(), warnings.end());
    return result;
  }));
}

pipeline::corridor::Summary summary_of(const pipeline::keypoints::KeypointsSummary& found) {
  pipeline::corridor::Summary summary;
  summary.frames = found.frames;
  summary.seconds = found.seconds;
  summary.rate_hz = found.rate_hz;
  summary.tracks = found.points * std::ssize(found.people);
  summary.measured = found.measured;
  summary.filled = found.filled;
  summary.body_points = {.people = std::ssize(found.people), .residual_px = found.residual_px, .noise = found.noise};
  summary.warnings = found.warnings;
  summary.stopped = found.stopped;
  return summary;
}

nb::tuple reconstruct_keypoints(nb::dict given) {
  const Options options(std::move(given));
  const Rig rig = rig_of(options);
  pipeline::jobs::ReconstructKeypoints job;
  const Rows rows(table_of(job), options);
  const Outputs outputs(options, format::Content::space, rig.cameras, &rows);
  return tuple_of(run_job(rows.listening(options), [&](const Hooks& hooks) {
    Result result;
    pipeline::keypoints::KeypointsSummary found;
    result.recording = pipeline::keypoints::keypoints_in_space(rig, resolved(job), found, hooks);
    outputs.write(result.recording);
    result.summary = summary_of(found);
    return result;
  }));
}

nb::dict dict_of(const pipeline::bodies::SolveSummary& solved) {
  nb::dict dict;
  dict["skeleton"] = solved.skeleton;
  dict["marker_set"] = solved.marker_set;
  dict["frames"] = solved.frames;
  dict["frames_without_markers"] = solved.empty;
  dict["rate_hz"] = solved.rate_hz;
  dict["seconds"] = solved.seconds;
  dict["rms_mm"] = 1000 * solved.rms_m;
  dict["worst_mm"] = 1000 * solved.worst_m;
  dict["initialisations"] = solved.starts;
  dict["not_recorded"] = solved.not_recorded;
  dict["not_known"] = solved.not_known;
  dict["warnings"] = solved.warnings;
  dict["interrupted"] = solved.stopped;
  nb::dict markers, coordinates;
  for (const auto& marker : solved.markers) markers[marker.label.c_str()] = 1000 * marker.rms_m;
  for (const auto& coordinate : solved.coordinates)
    coordinates[coordinate.name.c_str()] = nb::make_tuple(coordinate.lowest, coordinate.highest, coordinate.observed);
  dict["markers_rms_mm"] = markers;
  dict["coordinates"] = coordinates;
  return dict;
}

nb::dict solve(nb::dict given) {
  const Options options(std::move(given));
  pipeline::jobs::Solve job;
  const Rows rows(table_of(job), options);
  const pipeline::bodies::SolveOptions how = rows.resolved([&] { return resolved(job); });
  const auto recording = options.get<std::string>("recording", {});
  const auto outputs = options.get<std::vector<std::string>>("outputs", {});
  std::vector<std::string> inputs = rows.files(false), written = rows.files(true);
  inputs.push_back(recording);
  written.insert(written.end(), outputs.begin(), outputs.end());
  Outputs::keep_inputs(inputs, written);
  return dict_of(run_job(rows.listening(options), [&](const Hooks& hooks) {
    return pipeline::bodies::solve_skeleton(recording, job.skeleton, outputs, how, hooks);
  }));
}

/// The markers, and the summary as a dict: of each angle its lowest and highest value and its typical deviation, rad.
nb::tuple augment(nb::dict given) {
  const Options options(std::move(given));
  pipeline::jobs::Augment job;
  const Rows rows(table_of(job), options);
  const pipeline::bodies::AugmentOptions how = rows.resolved([&] { return resolved(job); });
  const auto recording = options.get<std::string>("recording", {});
  const Outputs outputs(options, format::Content::space, {}, &rows, {}, {recording});
  pipeline::bodies::AugmentedPerson person = run_job(rows.listening(options), [&](const Hooks& hooks) {
    pipeline::bodies::AugmentedPerson made = pipeline::bodies::augment_markers(recording, how, hooks);
    pipeline::bodies::write_augmented(made, {}, job.angles);
    outputs.write(made.recording);
    return made;
  });
  nb::dict dict, angles;
  for (const pipeline::bodies::AugmentedAngle& angle : person.angles) {
    if (const auto range = pipeline::bodies::range_of(angle))
      angles[angle.name.c_str()] = nb::make_tuple(range->lowest, range->highest, range->deviation);
  }
  dict["frames"] = person.frames;
  dict["augmented"] = person.augmented;
  dict["arms"] = person.arms;
  dict["marker_deviation_m"] = person.marker_deviation_m;
  dict["angles"] = angles;
  dict["warnings"] = person.warnings;
  return nb::make_tuple(std::move(person.recording), dict);
}

/// A rig, or live sources alone, each a camera.
nb::tuple live(nb::dict given) {
  const Options options(std::move(given));
  const auto cameras = options.get<std::vector<std::string>>("cameras", {});
  const Rig rig = cameras.empty() ? rig_of(options) : pipeline::live::rig_of_sources(cameras);
  pipeline::jobs::Live job{.rig_name = options.get<std::string>("rig", "the rig")};
  const auto targets = options.get<std::string>("targets", "markers");
  if (targets == "people") job.targets = pipeline::live::LiveTargets::people;
  if (targets == "keypoints") job.targets = pipeline::live::LiveTargets::keypoints;
  const Rows rows(table_of(job), options);
  std::vector<std::string> warnings;
  pipeline::live::LiveOptions how = rows.resolved([&] { return resolved(job, rig, warnings); });
  how.take = options.get<std::string>("take", {});
  const Outputs outputs(options, format::Content::space, rig.cameras, &rows);
  const auto phones = source::live::phone_servers_of(rig);  // their pages stay until the run has ended
  if (const auto invite = options.object("phones")) {
    for (const auto& server : phones) invite->get()(server->address(), server->fingerprint());
  }
  Listening listening = rows.listening(options);
  if (how.targets != pipeline::live::LiveTargets::markers)
    listening.options["targets"] = how.targets == pipeline::live::LiveTargets::people ? "people" : "keypoints";
  return tuple_of(run_job(listening, [&](const Hooks& hooks) {
    Result result;
    how.sinks = outputs.open(result.recording);
    result.summary = pipeline::live::live(rig, std::move(how), hooks);
    result.summary.warnings.insert(result.summary.warnings.begin(), warnings.begin(), warnings.end());
    return result;
  }));
}

void use_threads(int count) {
  static std::unique_ptr<tbb::global_control> control;
  control = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count));
  cv::setNumThreads(count);
}

}  // namespace

void bind_jobs(nb::module_& module) {
  module.def("job_options", &rows_of_job, nb::arg("job"));
  module.def("job_names", &pipeline::jobs::job_names);
  module.def("track_people", &track_people, nb::arg("options"));
  module.def("track_markers", &track_markers, nb::arg("options"));
  module.def("track_ground", &track_ground, nb::arg("options"));
  module.def("reconstruct", &reconstruct, nb::arg("options"));
  module.def("reconstruct_keypoints", &reconstruct_keypoints, nb::arg("options"));
  module.def("solve", &solve, nb::arg("options"));
  module.def("augment", &augment, nb::arg("options"));
  module.def("live", &live, nb::arg("options"));
  module.def("is_live", [](const std::string& source) { return !scheme_of(source).empty(); }, nb::arg("source"));
  module.def("use_threads", &use_threads, nb::arg("count"));
}

}  // namespace marey::python
