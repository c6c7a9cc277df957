#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "marey/core/error.h"
#include "marey/pipeline/track_people.h"

#include "commands.h"
#include "known.h"
#include "marker_options.h"
#include "people_options.h"
#include "run_hooks.h"
#include "track_ground.h"
#include "track_summary.h"

namespace marey::cli {
namespace {

struct TrackCommand {
  pipeline::PeopleInput input;
  std::string out;
  std::string format;
  std::string overlay;
  std::string plot;
  std::string filter;
  std::string targets = "people";
  PeopleFlags people;
  MarkerFlags markers;
  GroundFlags ground;
  bool live = false;
  bool quiet = false;
  bool json = false;
};

/// What the command line names and the format's own ending: video.mp4 becomes video.csv, here.
std::string default_output(const pipeline::PeopleInput& input, format::tracks::TrackFormat format) {
  const std::filesystem::path given = input.detections.empty() ? input.pictures : input.detections;
  std::string stem = (given.has_filename() ? given : given.parent_path()).stem().string();
  std::erase_if(stem, [](char c) { return c == '*' || c == '?' || c == '%'; });
  if (stem.empty() || stem == "." || stem == "..") stem = "video";
  return stem + "_tracks" + std::string(format::tracks::ending_of(format));
}

pipeline::TrackOutput output_of(const TrackCommand& command) {
  pipeline::TrackOutput output{.tracks = command.out, .overlay = command.overlay, .plot = command.plot};
  const auto by_ending = format::tracks::track_format_of(command.out);
  if (!command.format.empty()) {
    output.format = format::tracks::parse_track_format(command.format);
  } else if (by_ending) {
    output.format = *by_ending;
  } else if (command.people.outline) {
    output.format = format::tracks::TrackFormat::jsonl;  // the others hold no outlines
  }
  if (command.out == "-") output.tracks = "/dev/stdout";
  if (command.out.empty()) output.tracks = default_output(command.input, output.format);
  return output;
}

/// Runs `track(hooks)` and tells what came of it.
template <typename Track>
void run(const TrackCommand& command, const pipeline::TrackOutput& output, Track&& track) {
  run_with_progress(command.quiet, track, [&](const auto& summary, double elapsed) {
    if (command.json) {
      print_json(summary, output, elapsed);
    } else if (!command.quiet) {
      print_summary(summary, output, elapsed);
    }
  });
}

void run_on_ground(const TrackCommand& command) {
  if (command.targets != "people") throw Error("--ground follows people; markers stand on no ground: leave out one of the two");
  if (!command.input.detections.empty())
    throw Error("--ground takes a rig: name the cameras' detections there, or give CAMERA=FILE after it");
  if (!command.plot.empty()) throw Error("--plot shows ways in one picture; with --ground there is --pitch-view");
  track_on_ground({.rig = command.input.pictures,
                   .out = command.out,
                   .format = command.format,
                   .overlay = command.overlay,
                   .filter = command.filter,
                   .rate_hz = command.input.rate_hz,
                   .live = command.live,
                   .quiet = command.quiet,
                   .json = command.json},
                  command.ground, command.people);
}

void run(const TrackCommand& command) {
  if (command.ground.ground) return run_on_ground(command);
  if (command.input.pictures.ends_with(".toml"))
    throw Error("{} is a rig: add --ground to follow people on the ground that its cameras look at", command.input.pictures);
  if (!command.ground.sources.empty())
    throw Error("\"{}\" is one input too many; several cameras need a rig and --ground", command.ground.sources.front());
  const pipeline::TrackOutput output = output_of(command);
  if (command.targets == "markers") {
    if (command.people.outline) throw Error("--outline follows people; markers are points: leave out one of the two");
    if (!command.input.detections.empty()) throw Error("--detections brings boxes, not markers; leave out --targets markers");
    const pipeline::TrackMarkersOptions options = marker_options(command.markers, command.filter, command.live);
    run(command, output, [&](const pipeline::RunHooks& hooks) {
      return pipeline::track_markers(command.input.pictures, command.input.rate_hz, output, options, hooks);
    });
  } else {
    const pipeline::TrackPeopleOptions options = people_options(command.people, command.filter, command.live);
    run(command, output,
        [&](const pipeline::RunHooks& hooks) { return pipeline::track_people(command.input, output, options, hooks); });
  }
}

std::string filter_names() {
  std::string names;
  for (const filter::NamedFilter& filter : filter::named_filters()) names.append(names.empty() ? "" : ", ").append(filter.name);
  return names;
}

}  // namespace

void add_track(CLI::App& app) {
  auto options = std::make_shared<TrackCommand>();
  CLI::App* command = app.add_subcommand(
      "track", "Follow people or markers in a recording of one fixed camera, or people on the ground with several");
  auto* input =
      command->add_option("INPUT", options->input.pictures,
                          "a video file, a folder of pictures, or a pattern such as 'shot_%04d.png' or '*.jpg'; with --ground a "
                          "rig file");
  command
      ->add_option("--detections", options->input.detections,
                   "in place of INPUT, what another program detected: MOT text, frame,-1,left,top,width,height,score")
      ->excludes(input);
  command->add_option("-o,--output", options->out,
                      "where the tracks go; - for standard output (default: INPUT_tracks.txt in this folder)");
  command
      ->add_option("--format", options->format,
                   "one of " + format::tracks::track_format_names() + " (default: by OUT's ending, else mot, with --outline jsonl)")
      ->check(known([](const std::string& text) { format::tracks::parse_track_format(text); }));
  command->add_option("--overlay", options->overlay,
                      "a film with boxes, numbers and trails drawn into the pictures: FILE.mp4; with --ground a folder, which gets "
                      "CAMERA.mp4");
  command->add_option("--plot", options->plot, "a picture of the ways that were gone, in the image's coordinates: FILE.svg");
  command->add_option("--rate", options->input.rate_hz, "frames a second, where the file does not tell or is wrong")
      ->check(CLI::Validator(
          [](std::string& text) -> std::string {
            double rate = 0;
            const bool valid = CLI::detail::lexical_cast(text, rate) && rate > 0 && rate <= 1e6;
            return valid ? "" : "\"" + text + "\" is no rate; it must be a positive number of frames a second";
          },
          "HZ"));
  command->add_option("--filter", options->filter, "what predicts each person's motion, one of " + filter_names())
      ->check(known([](const std::string& text) { filter::filter_named(text); }));
  command->add_option("--targets", options->targets, "what is followed: people or markers")
      ->check(known([](const std::string& text) {
        if (text != "people" && text != "markers") throw Error("\"{}\" cannot be followed; these can: people, markers", text);
      }));
  command->add_flag("--live", options->live, "write each frame's tracks as they come; nothing is improved by what came later");
  command->add_flag("-q,--quiet", options->quiet, "no progress and no summary; warnings stay");
  command->add_flag("--json", options->json, "print the summary as JSON on standard output");
  add_people_options(*command, options->people);
  add_marker_options(*command, options->markers);
  add_ground_options(*command, options->ground);
  command->callback([options] {
    if (options->input.pictures.empty() && options->input.detections.empty()) {
      throw CLI::ValidationError("track", "give INPUT or --detections: what is to be tracked?");
    }
    run(*options);
  });
}

}  // namespace marey::cli
