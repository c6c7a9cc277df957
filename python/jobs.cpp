// The jobs, each from Python's options to the pipeline's.
#include <algorithm>

#include <tbb/global_control.h>

#include "marey/core/error.h"
#include "marey/core/source_name.h"
#include "marey/filter/usual_motion.h"
#include "marey/format/rig/rig_turns.h"
#include "marey/pipeline/live/live.h"
#include "marey/pipeline/live/live_feeds.h"
#include "marey/pipeline/markers/markers_in_picture.h"
#include "marey/pipeline/markers/reconstruct.h"
#include "marey/pipeline/people/ground_defaults.h"
#include "marey/pipeline/people/people_in_picture.h"
#include "marey/pipeline/people/track_ground.h"
#include "marey/pipeline/people/track_in_picture.h"

#include "job.h"

namespace marey::python {
namespace {

/// One camera: a path, frames of Python's, or another program's detections.
struct OneCamera {
  RigCamera camera;
  std::shared_ptr<Held> frames, detector;
  bool again = false;

  explicit OneCamera(const Options& options)
      : frames(options.object("frames")), detector(options.object("detector")), again(options.get("frames_again", false)) {
    camera.source = options.get<std::string>("source", {});
    camera.detections = options.get<std::string>("detections", {});
    camera.rate_hz = options.find<double>("rate");
    if (camera.rate_hz && !(*camera.rate_hz > 0))
      throw Error("the rate is {} frames a second; it must be positive", *camera.rate_hz);
  }

  pipeline::corridor::Feed feed() const {
    pipeline::corridor::FeedOptions how;
    if (frames != nullptr) how.open = [frames = frames] { return open_frames(frames); };
    how.opens_again = again;
    pipeline::corridor::Feed feed(camera, CameraId{}, how);
    if (detector != nullptr) feed.find(detector_of(detector));
    return feed;
  }
};

pipeline::corridor::Summary run_alone(pipeline::corridor::Feed feed, pipeline::corridor::Stage& stage,
                                      pipeline::corridor::Sinks& sinks, const Hooks& hooks) {
  std::vector<pipeline::corridor::Feed> feeds;
  feeds.push_back(std::move(feed));
  pipeline::corridor::Clock clock(std::move(feeds));
  return pipeline::corridor::run(stage, clock, sinks, hooks);
}

/// `make(feed)` is the job's stage.
template <typename Make>
nb::tuple in_picture(const Options& options, Make make) {
  const OneCamera camera(options);
  const Outputs outputs(options, format::Content::image, {&camera.camera, 1});
  return tuple_of(run_job(listening_of(options), [&](const Hooks& hooks) {
    const StopScope scope(hooks.stop);
    Result result;
    pipeline::corridor::Feed feed = camera.feed();
    pipeline::corridor::Sinks sinks;
    outputs.add_to(sinks, result.recording);
    const auto stage = make(feed);
    result.summary = run_alone(std::move(feed), *stage, sinks, hooks);
    return result;
  }));
}

/// The filter that was asked for: one of Python's own as it is, a named one as `named` makes it for the job; else `usual`.
filter::FilterOptions filter_of(const Options& options, const filter::FilterOptions& usual,
                                filter::FilterOptions (*named)(std::string_view) = filter::filter_named) {
  if (const auto own = options.object("own_filter")) return filter_of(own);
  const auto name = options.find<std::string>("filter");
  if (!name) return usual;
  return named(*name);
}

detect::DetectorOptions people_detector(const Options& options) {
  detect::people::PeopleDetectorOptions detector;
  if (const auto background = options.find<std::string>("background"))
    detector.background = detect::background::parse_background(*background);
  return detector;
}

nb::tuple track_people(nb::dict given) {
  const Options options(std::move(given));
  pipeline::people::PeopleInPictureOptions how;
  how.detector = people_detector(options);
  how.tracker.filter = filter_of(options, how.tracker.filter, filter::filter_for_people_in_picture);
  if (options.get("outline", false)) how.outlines.emplace();
  how.live = options.get("live", false);
  how.delay = options.get("delay", 0.0);
  how.seen_only = options.get("seen_only", false);
  how.beside = options.get<std::string>("beside", "/tmp/marey");
  return in_picture(options, [&](const pipeline::corridor::Feed& feed) { return pipeline::people::people_in_picture(feed, how); });
}

nb::tuple track_markers(nb::dict given) {
  const Options options(std::move(given));
  pipeline::markers::MarkersInPictureOptions how;
  how.markers.dark = options.get("dark", false);
  how.markers.threshold = options.find<double>("threshold");
  if (const auto colour = options.find<std::string>("colour")) how.markers.colour = detect::markers::parse_marker_colour(*colour);
  how.tracker.labels = options.get<std::vector<std::string>>("labels", {});
  how.tracker.filter = filter_of(options, how.tracker.filter);
  how.fit_noise = options.get("fit_noise", false);
  how.live = options.get("live", false);
  return in_picture(options,
                    [&](const pipeline::corridor::Feed& feed) { return pipeline::markers::markers_in_picture(feed, how); });
}

nb::tuple track_ground(nb::dict given) {
  const Options options(std::move(given));
  const Rig rig = rig_of(options);
  pipeline::people::PeopleOnGroundOptions how;
  how.detector = people_detector(options);
  how.rate_hz = options.find<double>("rate");
  how.live = options.get("live", false);
  how.margin = options.get("margin", how.margin);
  if (const auto teams = options.find<std::string>("teams")) how.teams.names = analyse::parse_teams(*teams);
  how.tracker.filter = filter_of(options, how.tracker.filter, filter::filter_for_people_on_ground);
  how.steady = options.get("steady", false);
  if (options.get("ball", false)) how.ball.emplace();
  if (how.ball && how.live)
    throw Error("{}", "ball=True needs the whole recording before it reports the ball; remove ball or live");
  if (const auto path = options.get<std::string>("rig", {}); !path.empty()) how.turning = format::rig::read_turning(path);
  if (const auto size = options.find<std::array<double, 2>>("pitch")) how.pitch = geometry::PitchSize{(*size)[0], (*size)[1]};
  for (const auto& corner : options.get<std::vector<std::array<double, 2>>>("area", {}))
    how.area.emplace_back(corner[0], corner[1]);
  pipeline::people::GroundChoices choices{.filter = options.has("filter") || options.has("own_filter")};
  if (const auto name = options.find<std::string>("associate"))
    choices.association = track::ground::ground_association_named(*name);
  how = pipeline::people::resolved(std::move(how), rig, choices);
  const Outputs outputs(options, format::Content::ground, rig.cameras);
  return tuple_of(run_job(listening_of(options), [&](const Hooks& hooks) {
    Result result;
    pipeline::corridor::Sinks sinks;
    outputs.add_to(sinks, result.recording);
    result.summary = pipeline::people::track_ground(rig, sinks, how, hooks);
    return result;
  }));
}

nb::tuple reconstruct(nb::dict given) {
  const Options options(std::move(given));
  const Rig rig = rig_of(options);
  pipeline::markers::MarkersInSpaceOptions how;
  how.rate_hz = options.find<double>("rate");
  how.noise_px = options.find<double>("noise");
  how.fill_s = options.get("fill", how.fill_s);
  how.predict_s = options.get("predict", how.predict_s);
  how.markers.threshold = options.find<double>("threshold");
  how.markers.dark = options.get("dark", false);
  how.tracker.filter = filter_of(options, how.tracker.filter);
  how.tracker.marker_width = options.get("marker_width", how.tracker.marker_width);
  how.tracker.max_speed = options.get("max_speed", how.tracker.max_speed);
  if (const auto labels = options.find<std::string>("labels")) how.set = format::motion::read_marker_set(*labels);
  const auto observations = options.get<std::string>("observations", {});
  const Outputs outputs(options, format::Content::space, rig.cameras);
  return tuple_of(run_job(listening_of(options), [&](const Hooks& hooks) {
    Result result;
    pipeline::corridor::Sinks sinks;
    outputs.add_to(sinks, result.recording);
    result.summary = pipeline::markers::reconstruct(rig, observations, sinks, how, hooks);
    return result;
  }));
}

/// A rig, or live sources alone, each a camera.
nb::tuple live(nb::dict given) {
  const Options options(std::move(given));
  const auto cameras = options.get<std::vector<std::string>>("cameras", {});
  const Rig rig = cameras.empty() ? rig_of(options) : pipeline::live::rig_of_sources(cameras);
  pipeline::live::LiveOptions how;
  how.targets = options.get("people", false) ? pipeline::live::LiveTargets::people : pipeline::live::LiveTargets::markers;
  how.ground = options.get("ground", false);
  how.space.markers.threshold = options.find<double>("threshold");
  how.space.markers.dark = options.get("dark", false);
  how.markers.markers = how.space.markers;
  how.space.predict_s = 0.1;
  how.people.detector = how.on_ground.detector = people_detector(options);
  how.on_ground.live = true;
  how.on_ground = pipeline::people::resolved(std::move(how.on_ground), rig, {});
  how.patience_s = options.get("patience", how.patience_s);
  how.take = options.get<std::string>("take", {});
  if (const auto labels = options.find<std::string>("labels")) how.space.set = format::motion::read_marker_set(*labels);
  const Outputs outputs(options, format::Content::space, rig.cameras);
  return tuple_of(run_job(listening_of(options), [&](const Hooks& hooks) {
    Result result;
    how.sinks = outputs.open(result.recording);
    result.summary = pipeline::live::live(rig, std::move(how), hooks);
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
  module.def("track_people", &track_people, nb::arg("options"));
  module.def("track_markers", &track_markers, nb::arg("options"));
  module.def("track_ground", &track_ground, nb::arg("options"));
  module.def("reconstruct", &reconstruct, nb::arg("options"));
  module.def("live", &live, nb::arg("options"));
  module.def("is_live", [](const std::string& source) { return !scheme_of(source).empty(); }, nb::arg("source"));
  module.def("use_threads", &use_threads, nb::arg("count"));
}

}  // namespace marey::python
