// The jobs, each on a thread of its own: the one that called waits, so that Ctrl-C ends it, and lets others have Python meanwhile.
#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <stop_token>
#include <thread>

#include <tbb/global_control.h>

#include "marey/core/error.h"
#include "marey/core/recording_sink.h"
#include "marey/core/rig_sources.h"
#include "marey/format/observations.h"
#include "marey/format/recording_file.h"
#include "marey/format/register.h"
#include "marey/format/rig/rig_file.h"
#include "marey/pipeline/calibrate_wand.h"
#include "marey/pipeline/markers_in_picture.h"
#include "marey/pipeline/people_in_picture.h"
#include "marey/pipeline/reconstruct.h"
#include "marey/pipeline/track_ground.h"
#include "marey/pipeline/track_in_picture.h"

#include "bindings.h"

namespace marey::python {
namespace {

constexpr double kBodyPixels = 100, kBodyMetres = 1.75;

/// What Python gave beside the input, by name; every job takes out what it knows.
class Options {
 public:
  explicit Options(nb::dict given) : given_(std::move(given)) {}

  bool has(const char* name) const { return given_.contains(name) && !nb::object(given_[name]).is_none(); }
  template <typename T>
  T get(const char* name, T usual) const {
    return has(name) ? nb::cast<T>(given_[name]) : usual;
  }
  template <typename T>
  std::optional<T> find(const char* name) const {
    return has(name) ? std::optional<T>(nb::cast<T>(given_[name])) : std::nullopt;
  }
  std::shared_ptr<Held> object(const char* name) const {
    return has(name) ? std::make_shared<Held>(nb::object(given_[name])) : nullptr;
  }

 private:
  nb::dict given_;
};

/// How a job is told about, and what Python hears of it.
struct Listening {
  std::shared_ptr<Held> progress;  ///< called with (step, done, total)
  std::map<std::string, std::string> options;
};

/// `work(hooks)` on another thread. Throws what it threw: an exception of Python's with its own traceback.
template <typename Work>
auto run_job(const Listening& listening, Work work) {
  std::optional<decltype(work(Hooks{}))> result;
  std::exception_ptr failure, interrupt;
  std::mutex guard;
  std::condition_variable changed;
  bool done = false;
  std::stop_source stop;
  Hooks hooks{.progress = {}, .stop = stop.get_token(), .options = listening.options};
  auto last = std::chrono::steady_clock::now();
  if (listening.progress) {
    hooks.progress = [&](const Progress& now) {
      const auto time = std::chrono::steady_clock::now();
      if (time - last < std::chrono::milliseconds(100)) return;
      last = time;
      const nb::gil_scoped_acquire gil;
      listening.progress->get()(std::string(now.step), now.done, now.total);
    };
  }
  {
    const nb::gil_scoped_release free;
    std::thread worker([&] {
      try {
        result.emplace(work(hooks));
      } catch (...) {
        failure = std::current_exception();
      }
      const std::lock_guard lock(guard);
      done = true;
      changed.notify_all();
    });
    std::unique_lock lock(guard);
    while (!changed.wait_for(lock, std::chrono::milliseconds(50), [&] { return done; })) {
      lock.unlock();
      {
        const nb::gil_scoped_acquire gil;
        if (!interrupt && PyErr_CheckSignals() != 0) {
          interrupt = std::make_exception_ptr(nb::python_error());
          stop.request_stop();
        }
      }
      lock.lock();
    }
    lock.unlock();
    worker.join();
  }
  if (interrupt) std::rethrow_exception(interrupt);
  if (failure) std::rethrow_exception(failure);
  return std::move(*result);
}

nb::dict dict_of(const pipeline::Summary& summary) {
  nb::dict dict;
  dict["frames"] = summary.frames;
  dict["seconds"] = summary.seconds;
  dict["rate_hz"] = summary.rate_hz;
  dict["tracks"] = summary.tracks;
  dict["samples"] = summary.samples;
  dict["measured"] = summary.measured;
  dict["filled"] = summary.filled;
  dict["predicted"] = summary.predicted;
  dict["detections"] = summary.detections;
  nb::dict left_out, figures;
  for (const auto& [name, count] : summary.left_out) left_out[name.c_str()] = count;
  for (const auto& [name, value] : summary.figures) figures[name.c_str()] = value;
  dict["left_out"] = left_out;
  dict["figures"] = figures;
  dict["notes"] = summary.notes;
  dict["warnings"] = summary.warnings;
  dict["stopped"] = summary.stopped;
  return dict;
}

struct Result {
  Recording recording;
  pipeline::Summary summary;
};

nb::tuple tuple_of(Result result) {
  return nb::make_tuple(std::move(result.recording), dict_of(result.summary));
}

/// Files by name, and objects of Python's; the recording in memory, unless it is not wanted.
class Outputs {
 public:
  Outputs(const Options& options, format::Content content) : content_(content) {
    files_ = options.get<std::vector<std::pair<std::string, std::string>>>("files", {});
    objects_ = options.get<std::vector<std::pair<nb::object, bool>>>("sinks", {});
    keep_ = options.get("keep", true);
    for (const auto& [object, pictures] : objects_) held_.push_back({std::make_shared<Held>(object), pictures});
    objects_.clear();
  }

  void add_to(pipeline::Sinks& sinks, Recording& recording) const {
    if (keep_) sinks.add(std::make_unique<RecordingSink>(recording));
    for (const auto& [path, name] : files_)
      sinks.add(format::create_recording(path, format::format_to_write(path, name, content_)));
    for (const auto& [object, pictures] : held_) sinks.add(sink_of(object, pictures));
  }

 private:
  format::Content content_;
  std::vector<std::pair<std::string, std::string>> files_;
  std::vector<std::pair<nb::object, bool>> objects_;
  std::vector<std::pair<std::shared_ptr<Held>, bool>> held_;
  bool keep_ = true;
};

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

  pipeline::Feed feed() const {
    pipeline::FeedOptions how;
    if (frames != nullptr) how.open = [frames = frames] { return open_frames(frames); };
    how.opens_again = again;
    pipeline::Feed feed(camera, CameraId{}, how);
    if (detector != nullptr) feed.find(detector_of(detector));
    return feed;
  }
};

pipeline::Summary run_alone(pipeline::Feed feed, pipeline::Stage& stage, pipeline::Sinks& sinks, const Hooks& hooks) {
  std::vector<pipeline::Feed> feeds;
  feeds.push_back(std::move(feed));
  pipeline::Clock clock(std::move(feeds));
  return pipeline::run(stage, clock, sinks, hooks);
}

Listening listening_of(const Options& options) {
  return {options.object("progress"), options.get<std::map<std::string, std::string>>("given", {})};
}

/// `make(feed)` is the job's stage.
template <typename Make>
nb::tuple in_picture(const Options& options, Make make) {
  const OneCamera camera(options);
  const Outputs outputs(options, format::Content::image);
  return tuple_of(run_job(listening_of(options), [&](const Hooks& hooks) {
    const StopScope scope(hooks.stop);
    Result result;
    pipeline::Feed feed = camera.feed();
    pipeline::Sinks sinks;
    outputs.add_to(sinks, result.recording);
    const auto stage = make(feed);
    result.summary = run_alone(std::move(feed), *stage, sinks, hooks);
    return result;
  }));
}

detect::DetectorOptions people_detector(const Options& options) {
  detect::people::PeopleDetectorOptions detector;
  if (const auto background = options.find<std::string>("background"))
    detector.background = detect::background::parse_background(*background);
  return detector;
}

nb::tuple track_people(nb::dict given) {
  const Options options(std::move(given));
  pipeline::PeopleInPictureOptions how;
  how.detector = people_detector(options);
  if (const auto filter = options.find<std::string>("filter");
      filter && filter::filter_named(*filter).index() != how.tracker.filter.index())
    how.tracker.filter = filter::scaled(filter::filter_named(*filter), 1 / kBodyPixels);
  if (options.get("outline", false)) how.outlines.emplace();
  how.live = options.get("live", false);
  how.delay = options.get("delay", 0.0);
  how.seen_only = options.get("seen_only", false);
  how.beside = options.get<std::string>("beside", "/tmp/marey");
  return in_picture(options, [&](const pipeline::Feed& feed) { return pipeline::people_in_picture(feed, how); });
}

nb::tuple track_markers(nb::dict given) {
  const Options options(std::move(given));
  pipeline::MarkersInPictureOptions how;
  how.markers.dark = options.get("dark", false);
  how.markers.threshold = options.find<double>("threshold");
  if (const auto colour = options.find<std::string>("colour")) how.markers.colour = detect::markers::parse_marker_colour(*colour);
  how.tracker.labels = options.get<std::vector<std::string>>("labels", {});
  if (const auto filter = options.find<std::string>("filter")) how.tracker.filter = filter::filter_named(*filter);
  how.fit_noise = options.get("fit_noise", false);
  how.live = options.get("live", false);
  return in_picture(options, [&](const pipeline::Feed& feed) { return pipeline::markers_in_picture(feed, how); });
}

/// A rig file's, or what observations name, with other sources as {camera: path} pairs.
Rig rig_of(const Options& options) {
  const auto path = options.get<std::string>("rig", {});
  const auto observations = options.get<std::string>("observations", {});
  Rig rig;
  if (options.has("rig_object")) {
    rig = options.get<Rig>("rig_object", {});
  } else if (!path.empty()) {
    rig = format::rig::read_rig(path);
  } else if (!observations.empty()) {
    rig = format::rig_of_observations(observations);
  } else {
    throw Error("{}", "give a rig, or observations");
  }
  set_sources(rig, options.get<std::vector<std::string>>("sources", {}));
  return rig;
}

nb::tuple track_ground(nb::dict given) {
  const Options options(std::move(given));
  const Rig rig = rig_of(options);
  pipeline::PeopleOnGroundOptions how;
  how.detector = people_detector(options);
  how.rate_hz = options.find<double>("rate");
  how.live = options.get("live", false);
  how.margin = options.get("margin", how.margin);
  if (const auto teams = options.find<std::string>("teams")) how.teams.names = analyse::parse_teams(*teams);
  if (const auto filter = options.find<std::string>("filter"))
    how.tracker.filter = filter::scaled(filter::filter_named(*filter), kBodyMetres / kBodyPixels);
  const auto has_source = [](const RigCamera& camera) { return !camera.source.empty(); };
  const bool pictures = std::any_of(rig.cameras.begin(), rig.cameras.end(), has_source);
  how.tracker.associate =
      track::ground::ground_association_named(options.get<std::string>("associate", pictures && !how.live ? "mht" : "gnn"));
  const auto size = options.find<std::array<double, 2>>("pitch");
  if (size || (rig.calibration && rig.calibration->method == "pitch"))
    how.pitch = size ? geometry::PitchSize{(*size)[0], (*size)[1]} : geometry::PitchSize{};
  const Outputs outputs(options, format::Content::ground);
  return tuple_of(run_job(listening_of(options), [&](const Hooks& hooks) {
    Result result;
    pipeline::Sinks sinks;
    outputs.add_to(sinks, result.recording);
    result.summary = pipeline::track_ground(rig, sinks, how, hooks);
    return result;
  }));
}

nb::tuple reconstruct(nb::dict given) {
  const Options options(std::move(given));
  const Rig rig = rig_of(options);
  pipeline::MarkersInSpaceOptions how;
  how.rate_hz = options.find<double>("rate");
  how.noise_px = options.find<double>("noise");
  how.fill_s = options.get("fill", how.fill_s);
  how.predict_s = options.get("predict", how.predict_s);
  how.markers.threshold = options.find<double>("threshold");
  how.markers.dark = options.get("dark", false);
  how.tracker.marker_width = options.get("marker_width", how.tracker.marker_width);
  how.tracker.max_speed = options.get("max_speed", how.tracker.max_speed);
  if (const auto labels = options.find<std::string>("labels")) how.set = format::motion::read_marker_set(*labels);
  const auto observations = options.get<std::string>("observations", {});
  const Outputs outputs(options, format::Content::space);
  return tuple_of(run_job(listening_of(options), [&](const Hooks& hooks) {
    Result result;
    pipeline::Sinks sinks;
    outputs.add_to(sinks, result.recording);
    result.summary = pipeline::reconstruct(rig, observations, sinks, how, hooks);
    return result;
  }));
}

nb::dict dict_of(const calibrate::FitQuality& fit) {
  nb::dict dict;
  dict["mean_px"] = fit.mean_px;
  dict["rms_px"] = fit.rms_px;
  dict["inliers"] = fit.inliers;
  dict["observations"] = fit.observations;
  return dict;
}

nb::tuple calibrate_wand(nb::dict given) {
  const Options options(std::move(given));
  const Rig rig = rig_of(options);
  pipeline::CalibrateWandOptions how;
  how.observations = options.get<std::string>("observations", {});
  how.wand.distances = options.get<std::vector<double>>("distances", {});
  how.synced = options.get("synced", false);
  how.how.seed = options.get<std::uint64_t>("seed", 1);
  how.markers.threshold = options.find<double>("threshold");
  how.markers.dark = options.get("dark", false);
  const auto found = run_job(listening_of(options), [&](const Hooks& hooks) { return pipeline::calibrate_wand(rig, how, hooks); });
  const calibrate::RigReport& report = found.found.report;
  nb::dict dict, cameras;
  dict["all"] = dict_of(report.all);
  dict["noise_px"] = report.noise_px;
  for (const calibrate::CameraReport& camera : report.cameras) cameras[camera.name.c_str()] = dict_of(camera.fit);
  dict["cameras"] = cameras;
  dict["grade"] = report.grade;
  dict["meaning"] = report.meaning;
  dict["notes"] = found.found.notes;
  dict["warnings"] = found.warnings;
  return nb::make_tuple(found.found.rig, dict);
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
  module.def("calibrate_wand", &calibrate_wand, nb::arg("options"));
  module.def("use_threads", &use_threads, nb::arg("count"));
}

}  // namespace marey::python
