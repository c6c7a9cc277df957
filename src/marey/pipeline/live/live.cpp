#include "marey/pipeline/live/live.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/files/source_name.h"
#include "marey/pipeline/corridor/preview.h"
#include "marey/pipeline/live/camera_videos.h"
#include "marey/pipeline/live/live_feeds.h"
#include "marey/pipeline/markers/named_in_take.h"
#include "marey/pipeline/markers/skeleton_in_space.h"
#include "marey/pipeline/markers/skeleton_stage.h"
#include "marey/pipeline/people/number_sink.h"

namespace marey::pipeline::live {
namespace {

/// A job's stage, watched.
class Watched final : public corridor::Stage {
 public:
  Watched(std::unique_ptr<corridor::Stage> stage, corridor::LiveMonitor& monitor, source::LiveTime& time)
      : stage_(std::move(stage)), monitor_(monitor), time_(time) {}

  RecordingHeader header() const override {
    RecordingHeader header = stage_->header();
    header.made_by.program = "marey live";
    return header;
  }
  void need_boxes() override { stage_->need_boxes(); }
  void need_foregrounds(std::function<void(corridor::FrameForeground)> give) override { stage_->need_foregrounds(std::move(give)); }
  std::span<const Instant> step(const FrameSet& frames) override {
    const Timestamp given = time_.now();
    const std::span<const Instant> known = stage_->step(frames);
    monitor_.received(stage_->news());
    monitor_.observed(frames, known, given, time_.now());
    return known;
  }
  std::unique_ptr<corridor::InstantSource> finish(const Hooks& hooks) override { return stage_->finish(hooks); }
  void report(corridor::Summary& summary) const override { stage_->report(summary); }

 private:
  std::unique_ptr<corridor::Stage> stage_;
  corridor::LiveMonitor& monitor_;
  source::LiveTime& time_;
};

bool feeds_find(LiveJob job, LiveTargets targets) {
  return job == LiveJob::markers_in_space || (job == LiveJob::preview && targets == LiveTargets::markers);
}

void adapt_to_markers(std::vector<corridor::Feed>& feeds, LiveJob job, LiveOptions& options) {
  for (std::size_t i = 0; i < feeds.size(); ++i) {
    if (options.targets == LiveTargets::markers) feeds[i].tune(options.camera_settings->tuning(i));
    if (feeds_find(job, options.targets))
      feeds[i].find(std::make_unique<corridor::TunedMarkers>(options.space.markers, options.camera_settings->tuning(i)));
  }
  options.markers.tuning = options.camera_settings->tuning(0);
}

std::unique_ptr<corridor::Stage> stage_of(LiveJob job, const std::vector<corridor::Feed>& feeds, const Rig& rig, double rate_hz,
                                          LiveOptions& options) {
  switch (job) {
    case LiveJob::markers_in_space:
      options.space.live = true;
      options.space.waits_for_names = false;
      options.space.naming = options.naming;
      return markers::markers_in_space(rig, rate_hz, options.space);
    case LiveJob::markers_in_image:
      options.markers.live = true;
      return markers::with_naming(markers::markers_in_image(feeds.front(), options.markers), options.naming);
    case LiveJob::people_in_image:
      options.people.live = true;
      return markers::with_naming(people::people_in_image(feeds.front(), options.people), options.naming);
    case LiveJob::people_on_ground:
      options.on_ground.live = true;
      return markers::with_naming(people::ground::people_on_ground(feeds, rig, options.on_ground), options.naming);
    case LiveJob::keypoints_in_space: {
      auto stage = markers::with_naming(keypoints::keypoints_live(rig, rate_hz, options.keypoints), options.naming);
      if (options.space.skeleton == nullptr) return stage;
      return markers::with_skeleton(std::move(stage), options.space.skeleton, markers::live_pose_options());
    }
    case LiveJob::preview:
      break;
  }
  const detect::DetectorOptions people = options.people.detector, markers = options.space.markers;
  return corridor::preview(feeds, rig, rate_hz, options.targets == LiveTargets::markers ? markers : people);
}

corridor::Sinks sinks_of(LiveOptions& options) {
  corridor::Sinks sinks(corridor::Sinks::Slow::skipped);
  if (!options.take.empty()) sinks.add(std::make_unique<corridor::Recorder>(options.take, options.recording, options.preroll_s));
  if (!options.images.empty()) sinks.add(std::make_unique<CameraVideos>(options.images, options.recording));
  if (!options.numbers.empty()) sinks.add(std::make_unique<people::NumberSink>(options.numbers));
  for (std::unique_ptr<Sink>& sink : options.sinks) sinks.add(std::move(sink));
  return sinks;
}

/// Why there is nothing, by what the cameras say.
std::string nothing_came(const corridor::LiveStatus& status) {
  std::string why = "no camera gave a frame";
  for (const CameraHealth& camera : status.cameras) {
    if (!camera.trouble.empty()) why += fmt::format("\n  camera \"{}\": {}", camera.name, camera.trouble);
  }
  return why;
}

/// What a user would not like to find out later: that much of what cameras saw was never processed.
void warn_of_losses(LiveSummary& summary) {
  constexpr double kMuch = 0.2;
  for (const CameraHealth& camera : summary.last.cameras) {
    const std::int64_t gone = camera.dropped(), all = camera.frames + camera.lost + camera.damaged;
    if (static_cast<double>(gone) <= kMuch * static_cast<double>(all)) continue;
    summary.warnings.push_back(fmt::format(
        "camera \"{}\" lost {:.0f} % of its frames, or there was no time for them; try a smaller image, a lower rate or "
        "fewer cameras",
        camera.name, 100.0 * static_cast<double>(gone) / static_cast<double>(all)));
  }
  const std::int64_t gone = summary.last.drops.superseded + summary.last.drops.incomplete, all = summary.last.instants + gone;
  if (static_cast<double>(gone) > kMuch * static_cast<double>(all))
    summary.warnings.push_back(
        fmt::format("{:.0f} % of the instants were dropped: cameras are faster than what looks at their images",
                    100.0 * static_cast<double>(gone) / static_cast<double>(all)));
}

void report_cameras_live(LiveSummary& summary, const corridor::Clock& clock, const corridor::LiveMonitor& monitor) {
  summary.last = monitor.status();
  if (summary.cameras.empty()) {
    for (std::size_t i = 0; i < clock.feeds().size(); ++i) {
      corridor::Summary::Camera& camera = summary.cameras.emplace_back();
      camera.name = clock.feeds()[i].camera().name;
      camera.frames = clock.frames(i);
      camera.missed = clock.missed(i);
    }
  }
  const auto step = [](const char* name, const StageTimes& times) {
    return corridor::Summary::StepTime{name, times.count(), times.quantile(0.5), times.quantile(0.99)};
  };
  if (clock.detecting().count() > 0 && clock.detecting().quantile(0.99) > 0)
    summary.steps.insert(summary.steps.begin(), step("detect", clock.detecting()));
  for (corridor::Summary::StepTime& each : monitor.steps()) summary.steps.push_back(std::move(each));
}

/// The names in the take that all cameras are played from; empty if they are not.
MarkerSet names_of_played(const Rig& rig) {
  const std::string path = path_of_source(rig.cameras.front().source);
  for (const RigCamera& camera : rig.cameras) {
    if (scheme_of(camera.source) != "play" || path_of_source(camera.source) != path) return {};
  }
  return markers::named_in_take(path);
}

}  // namespace

std::string_view to_string(LiveJob job) {
  switch (job) {
    case LiveJob::markers_in_image:
      return "markers in an image";
    case LiveJob::markers_in_space:
      return "markers in space";
    case LiveJob::people_in_image:
      return "people in an image";
    case LiveJob::people_on_ground:
      return "people on the ground";
    case LiveJob::keypoints_in_space:
      return "keypoints in space";
    case LiveJob::preview:
      break;
  }
  return "a preview";
}

LiveJob live_job(const Rig& rig, LiveTargets targets, bool ground) {
  if (ground) return LiveJob::people_on_ground;
  if (rig.cameras.size() == 1) return targets == LiveTargets::markers ? LiveJob::markers_in_image : LiveJob::people_in_image;
  const auto calibrated =
      std::count_if(rig.cameras.begin(), rig.cameras.end(), [](const RigCamera& camera) { return camera.camera().has_value(); });
  if (targets == LiveTargets::people || calibrated < 2) return LiveJob::preview;
  return targets == LiveTargets::keypoints ? LiveJob::keypoints_in_space : LiveJob::markers_in_space;
}

namespace {

/// Throws Error if an option is of another job than what these cameras give.
void check_options(const LiveOptions& options, LiveJob job) {
  if (options.space.skeleton != nullptr && job != LiveJob::markers_in_space && job != LiveJob::keypoints_in_space)
    throw Error("a skeleton is solved from markers or keypoints in space, of two calibrated cameras or more; these cameras give {}",
                to_string(job));
  if (options.space.learned_set != nullptr && job != LiveJob::markers_in_space)
    throw Error("a set names markers in space, of two calibrated cameras or more; these cameras give {}", to_string(job));
  if (!options.numbers.empty() && job != LiveJob::people_in_image && job != LiveJob::people_on_ground)
    throw Error("{}: shirt numbers are read of people in one camera's image or on the ground; these cameras give {}",
                options.numbers, to_string(job));
}

double max_rate_hz(const std::vector<corridor::Feed>& feeds) {
  double rate_hz = 0;
  for (const corridor::Feed& feed : feeds) rate_hz = std::max(rate_hz, feed.info().rate_hz.value_or(0));
  return rate_hz > 0 ? rate_hz : kDefaultRate;
}

}  // namespace

LiveSummary live(const Rig& rig, LiveOptions options, const Hooks& hooks) {
  if (options.policy.time == nullptr) options.policy.time = source::steady_time();
  if (options.recording == nullptr) options.recording = std::make_shared<corridor::RecordSwitch>(true);
  const StopScope scope(hooks.stop);
  if (options.camera_settings == nullptr)
    options.camera_settings = std::make_shared<CameraSettings>(rig, options.space.markers.threshold);
  std::vector<corridor::Feed> feeds = open_live_feeds(rig, options.policy, options.patience_s, options.camera_settings.get());
  const Rig fed = corridor::rig_as_fed(rig, feeds);
  LiveSummary summary;
  summary.job = live_job(fed, options.targets, options.ground);
  if (options.space.set.labels.empty() && options.space.learned_set == nullptr) options.space.set = names_of_played(fed);
  check_options(options, summary.job);
  adapt_to_markers(feeds, summary.job, options);
  corridor::LiveMonitor monitor(options.policy.time, options.status);
  monitor.set_recording([&] { return !options.take.empty() && options.recording->on(); });
  bool begun = false;
  corridor::ClockOptions how{.live = options.policy, .waiting = [&] {
                               begun = true;
                               monitor.tick();
                             }};
  auto stage = stage_of(summary.job, feeds, fed, max_rate_hz(feeds), options);
  corridor::Clock clock(std::move(feeds), how);
  corridor::Sinks sinks = sinks_of(options);
  monitor.watch(clock, sinks);
  if (options.begun) options.begun(summary.job, fed);
  Watched stages(std::move(stage), monitor, *options.policy.time);
  Hooks own = hooks;
  own.stop = {};  // the clock ends by itself when it is asked to: that is how a live run ends
  try {
    static_cast<corridor::Summary&>(summary) = corridor::run(stages, clock, sinks, own);
  } catch (const Error&) {
    if (begun && monitor.status().instants == 0) throw Error("{}", nothing_came(monitor.status()));
    throw;
  }
  std::error_code ignored;
  summary.recorded = !options.take.empty() && std::filesystem::exists(options.take, ignored);
  report_cameras_live(summary, clock, monitor);
  warn_of_losses(summary);
  return summary;
}

}  // namespace marey::pipeline::live
