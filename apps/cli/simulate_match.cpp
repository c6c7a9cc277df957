#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/core.h>

#include "marey/pipeline/simulate/match_files.h"

#include "command_line.h"
#include "commands.h"
#include "file_checks.h"
#include "json_value.h"
#include "pitch_size.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

struct SimulateMatch {
  pipeline::simulate::MatchFilesOptions files;
  std::string folder;
  std::array<int, 2> size{};
  std::string pitch = "105x68";
  bool recorded = false;
  std::string crown = "0x0";
  bool json = false;
  bool quiet = false;
};

geometry::GroundSurface parse_crown(const std::string& text) {
  constexpr double kMaxRaised = 0.5;  // m
  const std::vector<double> raised = numbers_in(text, 'x', closed(0, kMaxRaised), "heights ACROSSxALONG in m, as 0.15x0.2");
  if (raised.size() != 2) throw WrongUsage("\"{}\" is not a crown; write heights ACROSSxALONG in m, as 0.15x0.2", text);
  geometry::GroundSurface ground;
  ground.across = raised[0], ground.along = raised[1];
  return ground;
}

void run(const SimulateMatch& command) {
  pipeline::simulate::MatchFilesOptions options = command.files;
  options.cameras.pitch = parse_pitch_size(command.pitch);
  options.cameras.ground = parse_crown(command.crown);
  if (options.video.ball && !options.videos) throw WrongUsage("{}", "--ball is drawn into videos; add --render");
  if (command.size[0] > 0) options.cameras.size = {command.size[0], command.size[1]};
  if (command.recorded) options.video.degradation = simulate::people::ImageDegradation::recorded();
  make_folder(command.folder);
  with_progress(command.quiet, [&](const Hooks& hooks) { pipeline::simulate::write_match(options, command.folder, hooks); });
  if (command.json)
    print({{"folder", command.folder},
           {"rig", (std::filesystem::path(command.folder) / "rig.toml").string()},
           {"truth", (std::filesystem::path(command.folder) / "truth.csv").string()},
           {"seconds", options.seconds},
           {"seed", options.seed}});
  if (command.quiet || command.json) return;
  fmt::print(stderr, "{}: rig.toml (the exact cameras), truth.csv (where every person is), the boxes that each camera sees\n",
             command.folder);
}

void add_cameras(Command& match, SimulateMatch& options) {
  simulate::match::MatchCamerasOptions& cameras = options.files.cameras;
  using simulate::match::MatchStand;
  constexpr std::array<std::pair<const char*, MatchStand>, 5> kStands{{{"round", MatchStand::round},
                                                                       {"football", MatchStand::football},
                                                                       {"corners", MatchStand::corners},
                                                                       {"apart", MatchStand::apart},
                                                                       {"sides", MatchStand::sides}}};
  match.choice("--layout", cameras.stand, kStands,
               "where the cameras are: evenly round the pitch; two on one low stand beside it; two high behind opposite corners; "
               "two low beside "
               "one touchline, apart");
  match.whole("--cameras", cameras.cameras, "N", 1, 64, "how many round the pitch or at its sides");
  match.wholes("--size", options.size, "px", 64, 8192,
               "of the images: width and height (default: 1920 1080 round the pitch, else 3072 1728)");
  match.number("--rate", cameras.rate_hz, "Hz", closed(0.1, 1000), "frames a second");
  match.text("--pitch", options.pitch, "length and width of the pitch, LENGTHxWIDTH in m").check(parse_pitch_size);
  match.text("--crown", options.crown, "how far the pitch is raised in the middle across it and along it, ACROSSxALONG in m")
      .check(parse_crown);
  match.number("--offset", cameras.offset_s, "s", closed(0, 60), "cameras were started up to this much before or after the first");
  match.flag("--hide-offsets", options.files.hide_offsets, "rig.toml does not hold them; true_rig.toml does");
  match.flag("--pinhole", cameras.distorted, "lenses without distortion", false);
}

void add_videos(Command& match, SimulateMatch& options) {
  pipeline::simulate::MatchFilesOptions& files = options.files;
  match.flag("--render", files.videos, "video the match with every camera; rig.toml names the videos instead of the boxes");
  match.flag("--ball", files.video.ball, "videos: play with a ball; ball.csv and CAMERA_ball.csv are its truth");
  match.flag("--no-shadows", files.video.shadows, "videos: no person casts a shadow", false);
  match.flag("--broadcast-look", options.recorded,
             "videos as a broadcast chain shows them: blur, halo, colour that runs, blocks of a codec");
  match.number("--contact-shadow", files.video.contact, "fraction", closed(0, 1),
               "videos: of the light, that shoes keep from the ground");
  match.number("--noise", files.video.noise, "grey levels", closed(0, 50), "videos: standard deviation of the pixels");
  match.number("--light-variation", files.video.light_change, "fraction", closed(0, 0.9), "videos: by which the light swings");
  match.number("--shake", files.video.shake_px, "px", closed(0, 50),
               "videos: cameras shake in wind and by steps: how far their images move, root mean square");
  match.whole("--wrong-clicks", files.wrong_clicks, "N", 0, 100, "videos: how many of each camera's clicks are wrong");
}

void add_detector(Command& match, simulate::match::MatchDetectorOptions& detector) {
  match.number("--miss-rate", detector.missed, "fraction", closed(0, 1), "of people in plain view that a camera's detector misses");
  match.number("--size-noise", detector.size_noise, "fraction", closed(0, 1),
               "standard deviation of a box's width and height, of them");
  match.number(
      "--foot-error", detector.foot_error, "m", closed(0, 5),
      "standard deviation on the ground, by which boxes end beside the feet for half a second or so, each camera its own way");
  match.number("--foot-along", detector.foot_along, "fraction", closed(0, 1), "of that error's variance, along the view");
  match.number("--false-alarms", detector.false_alarms, "per frame", closed(0, 100), "boxes of no person");
}

}  // namespace

void add_simulate_match(Command& simulate) {
  auto options = std::make_shared<SimulateMatch>();
  Command command = simulate.subcommand(
      "match", "A football match seen by fixed cameras: 22 players and 3 referees, what each camera sees, and the exact truth");
  command.output_folder("-o,--output", options->folder, "folder for the rig, the boxes and their truth").required();
  command.number("--seconds", options->files.seconds, "s", closed(0.001, 86400), "length");
  command.seed(options->files.seed, "which of the endlessly many matches");
  command.flag("--boxes", options->files.boxes,
               "write what a detector says of each camera, which rig.toml names as the cameras' detections (default)");
  command.flag("--no-boxes", options->files.boxes, "leave them out", false);
  add_cameras(command, *options);
  add_detector(command, options->files.detector);
  add_videos(command, *options);
  command.reports(options->json, options->quiet);
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli
