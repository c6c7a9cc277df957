#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "marey/core/error.h"
#include "marey/core/overwriting.h"
#include "marey/detect/network/network_cost.h"
#include "marey/format/register.h"
#include "marey/pipeline/people/track_in_picture.h"
#include "marey/source/open_source.h"

#include "command_line.h"
#include "commands.h"
#include "marker_options.h"
#include "people_options.h"
#include "rig_inputs.h"
#include "run_hooks.h"
#include "track_ground.h"
#include "track_summary.h"

namespace marey::cli {
namespace {

enum class Targets { people, markers, keypoints };
constexpr std::array<std::pair<const char*, Targets>, 3> kTargets{
    {{"people", Targets::people}, {"markers", Targets::markers}, {"keypoints", Targets::keypoints}}};

struct TrackCommand {
  RigCamera input;  ///< the one camera, or with --ground `source` is the rig
  std::string out;
  std::string format;
  std::string overlay;
  std::string plot;
  std::string masks;
  std::string filter;
  Targets targets = Targets::people;
  PeopleFlags people;
  MarkerFlags markers;
  GroundFlags ground;
  bool live = false;
  std::optional<double> delay;
  bool seen_only = false;
  bool quiet = false;
  bool json = false;
};

/// What the command line names and the format's own ending: video.mp4 becomes video.csv, here.
std::string default_output(const RigCamera& input, const std::string& format) {
  const std::filesystem::path given = input.detections.empty() ? input.source : input.detections;
  std::string stem = (given.has_filename() ? given : given.parent_path()).stem().string();
  std::erase_if(stem, [](char c) { return c == '*' || c == '?' || c == '%'; });
  if (stem.empty() || stem == "." || stem == "..") stem = "video";
  return stem + "_tracks" + first_ending(*format::format_named(format, format::Content::image));
}

pipeline::people::TrackOutput output_of(const TrackCommand& command) {
  pipeline::people::TrackOutput output{.tracks = command.out, .overlay = command.overlay, .plot = command.plot};
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
  if (command.out.empty()) output.tracks = default_output(command.input, output.format);
  return output;
}

/// Runs `track(hooks)` and reports what came of it.
template <typename Track>
void run(const TrackCommand& command, const pipeline::people::TrackOutput& output, Track&& track) {
  if (command.people.outline && (output.format == "mot" || output.format == "csv"))
    warn({fmt::format("{}: holds no outlines; .jsonl and .marey do", output.tracks)});
  if (command.people.keypoints && output.format == "mot")
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
  return {.rig = command.input.source,
          .out = command.out,
          .format = command.format,
          .overlay = command.overlay,
          .filter = command.filter,
          .rate_hz = command.input.rate_hz,
          .live = command.live,
          .quiet = command.quiet,
          .json = command.json};
}

void run_on_ground(const TrackCommand& command) {
  if (command.targets == Targets::markers)
    throw WrongUsage("--ground follows people; markers stand on no ground: leave out one of the two");
  if (command.targets == Targets::keypoints)
    throw WrongUsage("--ground places people by their boxes; keypoints are of one camera's pictures: leave out one of the two");
  if (!command.input.detections.empty())
    throw WrongUsage("--ground takes a rig: name the cameras' detections there, or give CAMERA=FILE after it");
  if (!command.plot.empty()) throw WrongUsage("--plot shows ways in one picture; with --ground there is --pitch-view");
  if (!command.masks.empty()) throw WrongUsage("{}", "--masks is for one camera; leave out --ground, and give its film");
  track_on_ground(ground_command(command), command.ground, command.people);
}

void check_live(const TrackCommand& command) {
  if (command.delay && !command.live)
    throw WrongUsage("--delay {}: only --live has one; without it everything is looked at before anything is written",
                     *command.delay);
  const bool in_picture = command.targets != Targets::markers && !command.ground.ground;
  if (command.delay && !in_picture) throw WrongUsage("{}", "--delay is for people in one picture; leave it out");
  if (command.seen_only && !in_picture) throw WrongUsage("{}", "--seen-only is for people in one picture; leave it out");
}

void check_steady(const TrackCommand& command) {
  if (!command.people.steady) return;
  if (command.targets == Targets::markers)
    throw WrongUsage("{}", "--steady holds on to the scene that people walk in, and markers have none; leave it out");
  if (!command.input.detections.empty())
    throw WrongUsage("{}", "--steady steadies pictures, and --detections brings none; leave it out");
}

/// What the network costs on this computer, before a run over a video or a folder of pictures.
void print_network_cost(const detect::DetectorOptions& detector, const std::string& source) {
  const auto* network = std::get_if<detect::network::NetworkDetectorOptions>(&detector);
  if (network == nullptr || !(std::filesystem::is_regular_file(source) || std::filesystem::is_directory(source))) return;
  const cv::Size size = source::open_source(source)->info().size;
  if (size.empty()) return;
  const detect::network::NetworkCost cost = detect::network::network_cost(*network, size);
  fmt::print(stderr,
             "network: {:.0f} ms per tile with {} thread{}; searching a whole frame of {}x{} px takes about {} tiles ({:.1f} s), "
             "every {:g} to {:g} s of the video; in between, a tile around each group of people\n",
             1000 * cost.tile_s, cost.threads, cost.threads == 1 ? "" : "s", size.width, size.height, cost.tiles, cost.look_s(),
             network->everywhere_s, 4 * network->everywhere_s);
}

void run(TrackCommand& command) {
  command.people.keypoints = command.targets == Targets::keypoints;
  check_live(command);
  check_steady(command);
  if (command.ground.ground) return run_on_ground(command);
  if (command.input.source.ends_with(".toml"))
    throw WrongUsage("{} is a rig: add --ground to follow people on the ground that its cameras look at", command.input.source);
  if (!command.ground.sources.empty())
    throw WrongUsage("\"{}\" is one input too many; several cameras need a rig and --ground", command.ground.sources.front());
  if (!command.overlay.empty() && !command.overlay.ends_with(".mp4") && !is_stream(command.overlay))
    throw WrongUsage("--overlay {}: is an MP4 film; end its name in .mp4", command.overlay);
  const pipeline::people::TrackOutput output = output_of(command);
  if (command.targets == Targets::markers) {
    if (!command.masks.empty()) throw WrongUsage("{}", "--masks shows what the search for people sees; markers have none");
    if (command.people.outline) throw WrongUsage("--outline follows people; markers are points: leave out one of the two");
    const pipeline::markers::MarkersInPictureOptions options = marker_options(command.markers, command.filter, command.live);
    run(command, output,
        [&](const Hooks& hooks) { return pipeline::people::track_markers(command.input, output, options, hooks); });
  } else {
    pipeline::people::PeopleInPictureOptions options = people_options(command.people, command.filter, command.live);
    options.delay = command.delay.value_or(0);
    options.seen_only = command.seen_only;
    options.masks = command.masks;
    if (!command.masks.empty() && command.people.without_background)
      throw WrongUsage("{}", "--masks shows what the background model sees; leave out --without-background");
    if (!command.quiet && !command.json) print_network_cost(options.detector, command.input.source);
    run(command, output, [&](const Hooks& hooks) { return pipeline::people::track_people(command.input, output, options, hooks); });
  }
}

std::string filter_names() {
  std::string names;
  for (const filter::NamedFilter& filter : filter::named_filters()) names.append(names.empty() ? "" : ", ").append(filter.name);
  return names;
}

void add_inputs(Command& command, TrackCommand& options) {
  const Option input = command.input_file(
      "INPUT", options.input.source,
      "a video file, a folder of pictures, or a pattern such as 'shot_%04d.png' or '*.jpg'; with --ground a rig file");
  command
      .input_file("--detections", options.input.detections,
                  "in place of INPUT, what was detected: MOT text, frame,-1,left,top,width,height,score; of markers what "
                  "marey detect writes")
      .excludes(input);
  command.number("--rate", options.input.rate_hz, "Hz", kRates, "frames a second, where the file does not tell or is wrong");
  command.also_reads(
      [&options] { return options.ground.ground ? files_of_rig(options.input.source) : std::vector<std::string>{}; });
}

void add_outputs(Command& command, TrackCommand& options) {
  command.output_file("-o,--output", options.out,
                      "where the tracks go; - for standard output (default: INPUT_tracks.txt in this folder)");
  command
      .text("--format", options.format,
            "one of " + format::names_of_written(format::Content::image) +
                " (default: by OUTPUT's ending, else mot, with --outline jsonl, for keypoints csv)")
      .check([](const std::string& name) { format::format_to_write({}, name, format::Content::image); });
  command.output_file("--overlay", options.overlay,
                      "a film with boxes, numbers and trails drawn into the pictures: FILE.mp4; with --ground a folder, which gets "
                      "CAMERA.mp4");
  command.output_file("--plot", options.plot, "a picture of the paths, in the image's coordinates: FILE.svg").ends_in({".svg"});
  command.output_folder("--masks", options.masks,
                        "a new folder for what the background model sees: bin000001.png of the first frame, white on black");
  command.also_writes([&options]() -> std::vector<std::string> {
    if (options.ground.ground) return ground_files(ground_command(options), options.ground);
    if (options.out.empty()) return {output_of(options).tracks};
    return {};
  });
}

}  // namespace

void add_track(Command& program) {
  auto options = std::make_shared<TrackCommand>();
  Command command = program.subcommand(
      "track", "Follow people, their body points, or markers in a recording of one camera, or people on the ground with several");
  add_inputs(command, *options);
  add_outputs(command, *options);
  command.text("--filter", options->filter, "what predicts each person's motion, one of " + filter_names())
      .check(filter::filter_named);
  command.choice("--targets", options->targets, kTargets, "what is followed");
  command.flag("--live", options->live, "write each frame's tracks as they come; nothing is improved by what came later");
  command.number("--delay", options->delay, "s", closed(0, 60),
                 "with --live: look so far ahead before each frame's tracks are written (default: 0)");
  command.flag("--steady", options->people.steady,
               "the camera shakes (wind, steps): steady its pictures first; results are in the pixels of its rest");
  command.flag("--seen-only", options->seen_only, "leave out the rows of people whom nobody saw in that frame");
  command.reports(options->json, options->quiet);
  add_people_options(command, options->people);
  add_keypoint_options(command, options->people);
  add_marker_options(command, options->markers);
  add_ground_options(command, options->ground);
  command.runs([options] {
    if (options->input.source.empty() && options->input.detections.empty())
      throw WrongUsage("give INPUT or --detections: what is to be tracked?");
    run(*options);
  });
}

}  // namespace marey::cli
