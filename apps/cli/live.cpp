#include "marey/pipeline/live/live.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "marey/core/rig_sources.h"
#include "marey/files/source_name.h"
#include "marey/pipeline/jobs/live.h"
#include "marey/pipeline/live/camera_videos.h"
#include "marey/pipeline/live/live_feeds.h"

#include "camera_health.h"
#include "command_line.h"
#include "commands.h"
#include "json_value.h"
#include "live_outputs.h"
#include "live_screen.h"
#include "live_sources.h"
#include "phones_screen.h"
#include "realtime.h"
#include "run_hooks.h"
#include "set_figures.h"
#include "summary_figures.h"

namespace marey::cli {
namespace {

enum class Kept { results, video };
constexpr std::array<std::pair<const char*, Kept>, 2> kKept{{{"results", Kept::results}, {"video", Kept::video}}};

using pipeline::live::LiveJob;
using pipeline::live::LiveTargets;
constexpr std::array<std::pair<const char*, LiveTargets>, 3> kLiveTargets{
    {{"markers", LiveTargets::markers}, {"people", LiveTargets::people}, {"keypoints", LiveTargets::keypoints}}};

std::string name_of(LiveTargets targets) {
  for (const auto& [name, value] : kLiveTargets) {
    if (value == targets) return name;
  }
  return {};
}

struct LiveCommand {
  std::vector<std::string> sources;
  pipeline::jobs::Live job;
  std::string out;
  Kept record = Kept::results;
  bool armed = false, realtime = false;
  std::optional<double> for_s;
  LiveOutputOptions outputs;
  bool json = false, quiet = false;
};

Json as_json(const pipeline::live::LiveSummary& summary, const LiveCommand& command) {
  const pipeline::corridor::LiveDrops& drops = summary.last.drops;
  Json json = {{"job", to_string(summary.job)},
               {"seconds", summary.seconds},
               {"rate_hz", summary.rate_hz},
               {"instants", summary.frames},
               {"targets", summary.tracks},
               {"samples", summary.samples},
               {"numbers", path_or_null(command.job.numbers)},
               {"take", summary.recorded ? Json(command.out) : Json()},
               {"warnings", summary.warnings}};
  json["dropped"] = {{"superseded", drops.superseded},
                     {"incomplete", drops.incomplete},
                     {"empty", drops.empty},
                     {"late_frames", drops.late_frames},
                     {"overrun", drops.overrun}};
  for (std::size_t i = 0; i < summary.last.cameras.size(); ++i) {
    const CameraHealth& camera = summary.last.cameras[i];
    Json& reported = json["cameras"][camera.name];
    reported = health_json_of(camera, "frames", camera.frames);
    reported["connections"] = camera.connections;
    if (i < summary.cameras.size()) reported["missed"] = summary.cameras[i].missed;
  }
  if (const auto& keypoints = summary.body_points) {
    json["people"] = keypoints->people;
    json["people_in_images"] = keypoints->people_in_images;
    json["people_located"] = keypoints->people_located;
    json["regions"] = keypoints->regions;
    json["person_searches"] = keypoints->person_searches;
    json["noise"] = keypoints->noise;
  }
  add_set_figures(summary, json);
  add_skeleton_figures(summary, json);
  if (!summary.steps.empty()) json["stages"] = stages_of(summary);
  return json;
}

void print_live(const pipeline::live::LiveSummary& summary, const LiveCommand& command) {
  fmt::print(stderr, "{}: {} instants in {:.1f} s at {:g} Hz; {} targets\n", to_string(summary.job), summary.frames,
             summary.seconds, summary.rate_hz, summary.tracks);
  for (const CameraHealth& camera : summary.last.cameras) {
    fmt::print(stderr, "  {}{}\n", health_line_of(camera, camera.frames, "frames"),
               camera.connections > 1 ? fmt::format("; connected {} times", camera.connections) : "");
  }
  const pipeline::corridor::LiveDrops& drops = summary.last.drops;
  fmt::print(stderr, "drop: {} instants overtaken, {} incomplete, {} empty; {} frames late\n", drops.superseded, drops.incomplete,
             drops.empty, drops.late_frames);
  if (const auto& keypoints = summary.body_points)
    fmt::print(
        stderr, "keypoints: {} people; {} of {} in images are placed; {} regions were searched for points, {} images for people\n",
        keypoints->people, keypoints->people_located, keypoints->people_in_images, keypoints->regions, keypoints->person_searches);
  print_set_figures(summary);
  print_skeleton_figures(summary);
  print_stages(summary);
  if (!command.job.numbers.empty()) fmt::print(stderr, "numbers: {}\n", command.job.numbers);
  if (!command.out.empty()) fmt::print(stderr, "{}\n", summary.recorded ? "take: " + command.out : "nothing was recorded");
}

/// The folder of the images beside a take.
std::string images_of(const std::string& take) {
  return take.substr(0, take.rfind(".marey")) + "_video";
}

std::vector<std::string> played_files(const LiveCommand& command) {
  std::vector<std::string> files;
  for (const RigCamera& camera : rig_of_live_sources(command.sources).cameras) files.push_back(path_of_source(camera.source));
  return files;
}

std::vector<std::string> files_with_take(const LiveCommand& command) {
  if (command.record != Kept::video) return {};
  return pipeline::live::CameraVideos::files_of(images_of(command.out), rig_of_live_sources(command.sources));
}

pipeline::live::LiveOptions options_of(const LiveCommand& command, const Rig& rig) {
  std::vector<std::string> warnings;
  pipeline::live::LiveOptions options = resolved(command.job, rig, warnings);
  warn(warnings);
  options.take = command.out;
  if (command.record == Kept::video) options.images = images_of(command.out);
  options.recording = std::make_shared<pipeline::corridor::RecordSwitch>(!command.armed);
  options.policy.time = source::steady_time();
  return options;
}

/// LSL's channels are fixed at its first instant, when targets without given labels have none.
void report_of_slots(const LiveCommand& command) {
  const bool lsl = std::any_of(command.outputs.streams.streams.begin(), command.outputs.streams.streams.end(),
                               [](const std::string& target) { return target.starts_with("lsl"); });
  if (!lsl || !command.job.names.labels.empty() || !command.job.names.skeleton.empty()) return;
  fmt::print(stderr,
             "marey: lsl: no labels are given ({}): the outlet has {} slots, each with a track's ID and coordinates, NaN where "
             "empty\n",
             command.job.targets == LiveTargets::markers ? "--labels" : "people have none",
             command.outputs.streams.unlabelled_slots);
}

/// The part of the ground that the page shows.
viewer::LiveGround ground_of(const pipeline::people::ground::PeopleOnGroundOptions& options) {
  viewer::LiveGround ground{.pitch = options.pitch, .area = {}};
  for (const Vector<2>& corner : options.area) ground.area.emplace_back(corner.x(), corner.y(), 0);
  return ground;
}

/// Ends by a signal, by a key, or when the time is over.
struct LiveEnd {
  std::stop_source source;
  std::stop_callback<std::function<void()>> by_signal{stop_by_signals(), [this] { source.request_stop(); }};
};

void run(const LiveCommand& command) {
  if (command.realtime) {
    if (const auto refused = query_for_realtime()) warn({*refused});
  }
  const Rig rig = rig_of_live_sources(command.sources);
  pipeline::live::LiveOptions options = options_of(command, rig);
  options.camera_settings = std::make_shared<pipeline::live::CameraSettings>(rig, command.job.markers.threshold);
  options.naming = std::make_shared<pipeline::markers::TrackNaming>();
  LiveOutputs outputs(command.outputs, {options.policy.time, options.recording, options.camera_settings, options.naming},
                      command.job.targets == LiveTargets::markers, ground_of(options.on_ground), command.quiet);
  options.sinks = outputs.sinks();
  if (!command.quiet) report_of_slots(command);
  PhonesScreen phones(rig);
  if (!command.quiet) phones.invite();
  LiveEnd end;
  LiveScreen screen(command.quiet);
  const auto recording = options.recording;
  Keys keys([&](char key) {
    if (key == 'q') end.source.request_stop();
    if (key == 'r' && !command.out.empty()) recording->toggle();
  });
  options.begun = [&](pipeline::live::LiveJob job, const Rig& fed) {
    screen.begun(job, fed, keys.listens(), !command.out.empty());
  };
  options.status = [&](const pipeline::corridor::LiveStatus& status) {
    for (const std::string& sentence : phones.news()) screen.announce(sentence);
    screen.show(status);
    outputs.report(status);
    if (command.for_s && status.seconds >= *command.for_s) end.source.request_stop();
  };
  const Hooks hooks{.progress = {}, .stop = end.source.get_token(), .options = given_options()};
  const pipeline::live::LiveSummary summary = [&] {
    const StopScope scope(hooks.stop);
    return pipeline::live::live(rig, std::move(options), hooks);
  }();
  warn(summary.warnings);
  if (command.json) {
    Json reported = as_json(summary, command);
    reported["streams"] = json_of(outputs.streams());
    print(reported);
  } else if (!command.quiet) {
    print_live(summary, command);
    report_streams(outputs.streams());
  }
  if (summary.sink_failed) throw EndWith{1};
}

}  // namespace

void add_live(Command& program) {
  auto options = std::make_shared<LiveCommand>();
  Command command = program.subcommand("live", "Track what live cameras see, while they see it");
  add_live_sources(command, options->sources);
  command.choice("--targets", options->job.targets, kLiveTargets, "what is followed");
  command.output_file("-o,--output", options->out, "a take of it, NAME.marey, written as it grows").ends_in({".marey"});
  command.also_reads([options] { return played_files(*options); });
  command.also_writes([options] { return files_with_take(*options); });
  command.choice("--record", options->record, kKept,
                 "what is kept: the take alone, or the images too, a video of each camera and rig.toml in NAME_video");
  command.flag("--armed", options->armed, "record only from when r is pressed on, with the seconds before it");
  command.number("--duration", options->for_s, "s", closed(0.1, 1e7), "end after this long (default: on Ctrl-C, or q)");
  command.flag("--realtime-priority", options->realtime, "go before other programs, where the system allows it");
  const pipeline::jobs::Table& rows = command.rows(table_of(options->job));
  command.records([&rows, options = options.get()] {
    auto given = rows.given();
    if (options->job.targets != LiveTargets::markers) given["targets"] = name_of(options->job.targets);
    return given;
  });
  add_live_outputs(command, options->outputs);
  command.reports(options->json, options->quiet);
  command.runs([options] {
    options->outputs.take = options->out;
    if (is_rig_file(options->sources.front())) options->outputs.rig = options->sources.front();
    options->job.rig_name = options->sources.front();
    if (options->job.ground && options->job.targets == LiveTargets::markers) options->job.targets = LiveTargets::people;
    options->outputs.streams.unlabelled_slots =
        std::min(stream::kMaxUnlabelledSlots, static_cast<std::size_t>(options->job.markers.max_markers));
    if (options->armed && options->out.empty()) throw WrongUsage("{}", "--armed: name the take with -o");
    if (options->record == Kept::video && options->out.empty()) throw WrongUsage("{}", "--record video: name the take with -o");
    run(*options);
  });
}

}  // namespace marey::cli
