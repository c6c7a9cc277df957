#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>

#include "marey/core/error.h"
#include "marey/detect/network/network_cost.h"
#include "marey/files/overwriting.h"
#include "marey/format/register.h"
#include "marey/pipeline/jobs/track_image.h"
#include "marey/source/open_source.h"

#include "command_line.h"
#include "commands.h"
#include "rig_inputs.h"
#include "run_hooks.h"
#include "track_ground.h"
#include "track_summary.h"

namespace marey::cli {
namespace {

enum class Targets { people, markers, keypoints };
constexpr std::array<std::pair<const char*, Targets>, 3> kTargets{
    {{"people", Targets::people}, {"markers", Targets::markers}, {"keypoints", Targets::keypoints}}};

const char* name_of(Targets targets) {
  return kTargets[static_cast<std::size_t>(targets)].first;
}

/// One command, four jobs: options of several of them are set in all.
struct TrackCommand {
  std::string source;  ///< with --ground the rig
  std::string out;
  std::string format;
  Targets targets = Targets::people;
  pipeline::jobs::TrackPeople people, keypoints{.keypoints = true};
  pipeline::jobs::TrackMarkers markers;
  GroundCommand ground;
  pipeline::jobs::Table *people_rows = nullptr, *keypoint_rows = nullptr, *marker_rows = nullptr, *ground_rows = nullptr;
  bool quiet = false;
  bool json = false;

  bool on_ground = false;
  const std::string& detections() const { return people.input.camera.detections; }
  pipeline::jobs::Table& rows() const {
    if (on_ground) return *ground_rows;
    return targets == Targets::markers ? *marker_rows : targets == Targets::keypoints ? *keypoint_rows : *people_rows;
  }
};

/// What the command line names and the format's own ending: video.mp4 becomes video.csv, here.
std::string default_output(const TrackCommand& command, const std::string& format) {
  const std::filesystem::path given = command.detections().empty() ? command.source : command.detections();
  std::string stem = (given.has_filename() ? given : given.parent_path()).stem().string();
  std::erase_if(stem, [](char c) { return c == '*' || c == '?' || c == '%'; });
  if (stem.empty() || stem == "." || stem == "..") stem = "video";
  return stem + "_tracks" + first_ending(*format::format_named(format, format::Content::image));
}

pipeline::people::TrackOutput output_of(const TrackCommand& command) {
  const pipeline::jobs::ImageInput& input = command.people.input;
  pipeline::people::TrackOutput output{.tracks = command.out,
                                       .overlay = input.overlay,
                                       .copy = input.copy,
                                       .blur_faces = !input.blur.empty(),
                                       .plot = input.plot,
                                       .target_masks = command.people.target_masks,
                                       .numbers = command.people.numbers,
                                       .masks = command.people.masks};
  const bool named = !command.out.empty() && !is_stream(command.out) && !std::filesystem::is_directory(command.out);
  if (named || !command.format.empty()) {
    output.format = format::format_to_write(command.out, command.format, format::Content::image).name;
  } else {
    const format::Format* by_ending = format::format_of_name(command.out, format::Content::image);
    output.format = by_ending != nullptr                    ? by_ending->name
                    : command.people.outline                ? "jsonl"  // the others hold no outlines
                    : command.targets == Targets::keypoints ? "csv"    // MOT text holds no points
                                                            : "mot";
  }
  if (command.out == "-") output.tracks = "/dev/stdout";
  if (command.out.empty()) output.tracks = default_output(command, output.format);
  return output;
}

/// Runs `track(hooks)` and reports the result.
template <typename Track>
void run(const TrackCommand& command, const pipeline::people::TrackOutput& output, Track&& track) {
  if (command.people.outline && (output.format == "mot" || output.format == "csv"))
    warn({fmt::format("{}: holds no outlines; .jsonl and .marey do", output.tracks)});
  if (command.targets == Targets::keypoints && output.format == "mot")
    warn({fmt::format("{}: holds no keypoints; .csv, .jsonl and .marey do", output.tracks)});
  run_with_progress(command.quiet, track, [&](const auto& summary, double elapsed) {
    if (command.json) {
      print_json(summary, output, command.targets == Targets::markers, elapsed);
    } else if (!command.quiet) {
      print_summary(summary, output, command.targets == Targets::markers, elapsed);
    }
  });
}

GroundCommand ground_command(const TrackCommand& command) {
  GroundCommand ground = command.ground;
  ground.rig = command.source;
  ground.out = command.out;
  ground.format = command.format;
  ground.quiet = command.quiet;
  ground.json = command.json;
  return ground;
}

void check_on_ground(const TrackCommand& command) {
  if (command.targets == Targets::markers)
    throw WrongUsage("--ground tracks people; markers are not on the ground: omit one of the two");
  if (command.targets == Targets::keypoints)
    throw WrongUsage("--ground localises people by their boxes; keypoints are of one camera's images: omit one of the two");
  if (!command.people.input.plot.empty())
    throw WrongUsage("--plot shows trajectories in one image; with --ground there is --pitch-view");
}

/// Options that would change the output much: without effect they are refused, the others are named in a warning.
constexpr std::array<std::string_view, 6> kRefusedElsewhere{"target-masks", "foreground-masks", "contour",
                                                            "lag",          "measured-only",    "stabilise"};

/// Options that were given and that the job does not have.
void check_of_other_jobs(const TrackCommand& command) {
  const std::string job = command.on_ground ? "--ground" : fmt::format("--targets {}", name_of(command.targets));
  std::set<std::string> without_effect;
  for (pipeline::jobs::Table* rows : {command.keypoint_rows, command.marker_rows, command.ground_rows}) {
    for (const pipeline::jobs::Option& row : rows->options()) {
      if (!row.given || command.rows().find(row.name) != nullptr) continue;
      if (std::find(kRefusedElsewhere.begin(), kRefusedElsewhere.end(), row.name) != kRefusedElsewhere.end())
        throw WrongUsage("--{} is not an option of {}; omit one of the two", row.name, job);
      without_effect.insert("--" + row.name);
    }
  }
  for (const std::string& option : without_effect) warn({fmt::format("{} has no effect with {}", option, job)});
}

/// What the network costs on this computer, before a run over a video or a folder of images.
void print_network_cost(const detect::DetectorOptions& detector, const std::string& source) {
  const auto* network = std::get_if<detect::network::NetworkDetectorOptions>(&detector);
  if (network == nullptr || !(std::filesystem::is_regular_file(source) || std::filesystem::is_directory(source))) return;
  const cv::Size size = source::open_source(source)->info().size;
  if (size.empty()) return;
  const detect::network::NetworkCost cost = detect::network::network_cost(*network, size);
  fmt::print(stderr,
             "network: {:.0f} ms per tile with {} thread{}; searching a whole frame of {}x{} px takes about {} tiles ({:.1f} s), "
             "every {:g} to {:g} s of the video; in between, a tile around each group of people\n",
             1000 * cost.tile_s, cost.threads, cost.threads == 1 ? "" : "s", size.width, size.height, cost.tiles, cost.frame_s(),
             network->everywhere_s, 4 * network->everywhere_s);
}

template <typename Job>
void run_in_image(TrackCommand& command, Job& job) {
  job.input.camera.source = command.source;
  const pipeline::people::TrackOutput output = output_of(command);
  const auto options = resolved(job);
  if constexpr (std::is_same_v<Job, pipeline::jobs::TrackMarkers>) {
    run(command, output,
        [&](const Hooks& hooks) { return pipeline::people::track_markers(job.input.camera, output, options, hooks); });
  } else {
    if (!command.quiet && !command.json) print_network_cost(options.detector, command.source);
    run(command, output,
        [&](const Hooks& hooks) { return pipeline::people::track_people(job.input.camera, output, options, hooks); });
  }
}

void run(TrackCommand& command) {
  if (command.on_ground) check_on_ground(command);
  check_of_other_jobs(command);
  if (command.on_ground) return track_on_ground(ground_command(command));
  if (command.source.ends_with(".toml"))
    throw WrongUsage("{} is a rig: add --ground to track people on the ground that its cameras face", command.source);
  if (!command.ground.sources.empty())
    throw WrongUsage("\"{}\" is one input too many; several cameras need a rig and --ground", command.ground.sources.front());
  if (command.targets == Targets::markers) return run_in_image(command, command.markers);
  run_in_image(command, command.targets == Targets::keypoints ? command.keypoints : command.people);
}

void add_inputs(Command& command, TrackCommand& options) {
  command.input_file("INPUT", options.source,
                     "a video file, a folder of images, or a pattern such as 'shot_%04d.png' or '*.jpg'; with --ground a rig file");
  command.input_files("SOURCES", options.ground.sources, "with --ground: CAMERA=FILE, in place of the rig's source or detections");
  command.also_reads([&options] { return options.on_ground ? files_of_rig(options.source) : std::vector<std::string>{}; });
}

void add_outputs(Command& command, TrackCommand& options) {
  command.output_file("-o,--output", options.out,
                      "where the tracks are written; - for standard output (default: INPUT_tracks.txt in this folder)");
  command
      .text("--format", options.format,
            "one of " + format::names_of_written(format::Content::image) +
                " (default: by OUTPUT's ending, else mot, with --contour jsonl, for keypoints csv)")
      .check(format::check_written_name);
  command.also_writes([&options]() -> std::vector<std::string> {
    if (options.on_ground) return ground_files(ground_command(options));
    if (options.out.empty()) return {output_of(options).tracks};
    return {};
  });
}

void add_jobs(Command& command, TrackCommand& options) {
  using pipeline::jobs::table_of;
  command.choice("--targets", options.targets, kTargets, "the targets");
  const Option ground =
      command.flag("--ground", options.on_ground, "INPUT is a rig file: track people on the ground that its cameras face");
  command.text("--camera", options.ground.job.output.boxes_of, "with --ground and --format mot: in whose view").needs(ground);
  options.people_rows = &command.rows(table_of(options.people));
  options.keypoint_rows = &command.rows(table_of(options.keypoints));
  options.marker_rows = &command.rows(table_of(options.markers), "with --targets markers");
  options.ground_rows = &command.rows(table_of(options.ground.job), "with --ground");
  command.records([&options] { return options.rows().given(); });
}

}  // namespace

void add_track(Command& program) {
  auto options = std::make_shared<TrackCommand>();
  Command command = program.subcommand(
      "track", "Track people, their body points, or markers in a recording of one camera, or people on the ground with several");
  add_inputs(command, *options);
  add_outputs(command, *options);
  command.reports(options->json, options->quiet);
  add_jobs(command, *options);
  command.runs([options] {
    if (options->source.empty() == options->detections().empty())
      throw WrongUsage("give either INPUT or --detections: what is to be tracked?");
    run(*options);
  });
}

}  // namespace marey::cli
