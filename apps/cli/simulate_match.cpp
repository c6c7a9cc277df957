#include <array>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include <fmt/core.h>

#include "marey/core/error.h"
#include "marey/pipeline/simulation_files.h"

#include "commands.h"
#include "pitch_size.h"
#include "progress_bar.h"

namespace marey::cli {
namespace {

struct SimulateMatch {
  pipeline::MatchFilesOptions files;
  std::string folder;
  std::array<int, 2> size{};
  std::string pitch = "105x68";
  bool quiet = false;
};

void run(const SimulateMatch& command) {
  pipeline::MatchFilesOptions options = command.files;
  options.cameras.pitch = parse_pitch_size(command.pitch);
  if (command.size[0] > 0) options.cameras.size = {command.size[0], command.size[1]};
  std::error_code error;
  std::filesystem::create_directories(command.folder, error);
  if (error) throw Error("{}: the folder cannot be made ({})", command.folder, error.message());
  {
    ProgressBar bar(command.quiet);
    pipeline::write_match(options, command.folder, [&](std::int64_t done, std::int64_t all) { bar.show("frames", done, all); });
  }
  if (command.quiet) return;
  fmt::print(stderr, "{}: rig.toml (the exact cameras), truth.csv (where everybody is), the boxes that each camera sees\n",
             command.folder);
}

void add_cameras(CLI::App& match, SimulateMatch& options) {
  simulate::match::MatchCamerasOptions& cameras = options.files.cameras;
  const std::map<std::string, simulate::match::MatchStand> stands{{"round", simulate::match::MatchStand::round},
                                                                  {"football", simulate::match::MatchStand::football},
                                                                  {"corners", simulate::match::MatchStand::corners}};
  match
      .add_option("--stand", cameras.stand,
                  "where the cameras are: evenly round the pitch; two on one low stand beside it; two high behind opposite corners")
      ->transform(CLI::CheckedTransformer(stands))
      ->default_str("round");
  match.add_option("--cameras", cameras.cameras, "how many round the pitch")->check(CLI::Range(1, 64))->capture_default_str();
  match
      .add_option("--size", options.size,
                  "of the pictures, px: width and height (default: 1920 1080 round the pitch, else 3072 1728)")
      ->check(CLI::Range(64, 8192));
  match.add_option("--rate", cameras.rate_hz, "frames a second")->check(CLI::Range(0.1, 1000.0))->capture_default_str();
  match.add_option("--pitch", options.pitch, "length and width of the pitch, m")->capture_default_str();
  match.add_option("--offset", cameras.offset_s, "cameras were started up to this much before or after the first, s")
      ->check(CLI::Range(0.0, 60.0))
      ->capture_default_str();
  match.add_flag("--hide-offsets", options.files.hide_offsets, "rig.toml does not tell them; true_rig.toml does");
  match.add_flag("!--pinhole", cameras.distorted, "lenses without distortion");
}

void add_films(CLI::App& match, pipeline::MatchFilesOptions& files) {
  match.add_flag("--render", files.films, "film the match with every camera; rig.toml names the films instead of the boxes");
  match.add_flag("!--no-shadows", files.film.shadows, "films: nobody casts a shadow");
  match.add_option("--noise", files.film.noise, "films: standard deviation of the pixels, grey levels")
      ->check(CLI::Range(0.0, 50.0))
      ->capture_default_str();
  match.add_option("--light", files.film.light_change, "films: the share by which the light swings")
      ->check(CLI::Range(0.0, 0.9))
      ->capture_default_str();
  match.add_option("--wrong-clicks", files.wrong_clicks, "films: how many of each camera's clicks are wrong")
      ->check(CLI::Range(0, 100))
      ->capture_default_str();
}

void add_detector(CLI::App& match, simulate::match::MatchDetectorOptions& detector) {
  match.add_option("--missed", detector.missed, "share of people in plain view that a camera's detector misses")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  match.add_option("--size-noise", detector.size_noise, "standard deviation of a box's width and height, as a share of them")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  match.add_option("--false-alarms", detector.false_alarms, "boxes of nobody, a frame")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
}

}  // namespace

void add_simulate_match(CLI::App& simulate) {
  auto options = std::make_shared<SimulateMatch>();
  CLI::App* match = simulate.add_subcommand(
      "match", "A football match seen by fixed cameras: 22 players and 3 referees, what each camera sees, and the exact truth");
  match->add_option("-o,--output", options->folder, "folder for the rig, the boxes and their truth")->required();
  match->add_option("--seconds", options->files.seconds, "length")->check(CLI::Range(0.001, 86400.0))->capture_default_str();
  match->add_option("--seed", options->files.seed, "which of the endlessly many matches")->capture_default_str();
  match->add_flag("--boxes,!--no-boxes", options->files.boxes,
                  "write what a detector says of each camera, which rig.toml names as the cameras' detections (default)");
  add_cameras(*match, *options);
  add_detector(*match, options->files.detector);
  add_films(*match, options->files);
  match->add_flag("-q,--quiet", options->quiet, "say nothing");
  match->callback([options] { run(*options); });
}

}  // namespace marey::cli
