#include <array>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "marey/core/error.h"
#include "marey/pipeline/simulation_files.h"

#include "choice.h"
#include "commands.h"
#include "progress_bar.h"

namespace marey::cli {
namespace {

struct SimulateRoom {
  simulate::room::RoomOptions room;
  pipeline::RoomFilesOptions files;
  std::string folder = "room";
  std::array<int, 2> size{1280, 1024};
  std::array<double, 3> volume{4, 4, 2.5};
  std::string wand;
  std::string bump;
  bool quiet = false;
};

std::vector<double> numbers(const std::string& text, const char* option, const char* form) {
  std::vector<double> values;
  std::size_t at = 0;
  while (at <= text.size()) {
    const std::string part = text.substr(at, text.find(',', at) - at);
    std::size_t used = 0;
    try {
      values.push_back(std::stod(part, &used));
    } catch (const std::exception&) {
      used = part.size() + 1;
    }
    if (used != part.size()) throw Error("{} {}: \"{}\" is no number; write {}", option, text, part, form);
    at += part.size() + 1;
  }
  return values;
}

simulate::room::RoomOptions room_of(const SimulateRoom& command) {
  simulate::room::RoomOptions room = command.room;
  room.picture = {command.size[0], command.size[1]};
  room.volume = {command.volume[0], command.volume[1], command.volume[2]};
  if (command.wand == "led") {
    room.wand = {0};
  } else if (!command.wand.empty()) {
    room.wand = numbers(command.wand, "--wand", "the markers' places in m, as 0,0.12,0.30, or led");
    for (std::size_t i = 1; i < room.wand.size(); ++i) {
      if (!(room.wand[i] > room.wand[i - 1])) throw Error("--wand {}: the places must grow", command.wand);
    }
  }
  if (!command.bump.empty()) {
    const char* form = "CAMERA,SECONDS,ANGLE: the camera's number from 1, when, and by how many rad";
    const std::vector<double> values = numbers(command.bump, "--bump", form);
    if (values.size() != 3) throw Error("--bump {}: write {}", command.bump, form);
    if (!(values[0] >= 1 && values[0] <= room.cameras)) throw Error("--bump {}: there are {} cameras", command.bump, room.cameras);
    room.bump =
        simulate::room::RoomOptions::Bump{.camera = static_cast<int>(values[0]) - 1, .time_s = values[1], .angle = values[2]};
  }
  return room;
}

void run(const SimulateRoom& command) {
  const simulate::room::RoomScene scene(room_of(command));
  std::error_code error;
  std::filesystem::create_directories(command.folder, error);
  if (error) throw Error("{}: the folder cannot be made ({})", command.folder, error.message());
  {
    ProgressBar bar(command.quiet);
    pipeline::write_room(scene, command.folder, command.files,
                         [&](std::int64_t done, std::int64_t all) { bar.show("frames", done, all); });
  }
  if (command.quiet) return;
  fmt::print(stderr,
             "{} cameras, {} markers, {} frames at {} Hz\n{}: rig.toml (the truth), start.toml, observations.csv, blobs.csv, "
             "truth.csv{}\n",
             scene.rig().cameras.size(), scene.labels().size(), scene.options().frames, scene.options().rate_hz, command.folder,
             command.files.videos ? ", and a video of each camera" : "");
}

void add_scene(CLI::App& room, SimulateRoom& options) {
  simulate::room::RoomOptions& scene = options.room;
  std::map<std::string, simulate::room::RoomMotion> motions;
  for (const simulate::room::NamedRoomMotion& known : simulate::room::room_motions()) motions.emplace(known.name, known.motion);
  add_choice(
      room, "--motion", scene.motion, motions,
      "somebody with markers who walks, waves or stands still; a wand that is waved; an L-frame on the ground; a cloud of free "
      "markers")
      ->default_str("walk");
  room.add_option("--cameras", scene.cameras, "how many, round the volume")->check(CLI::Range(1, 256))->capture_default_str();
  room.add_option("--markers", scene.markers, "how many, on the body or free")->check(CLI::Range(1, 2000))->capture_default_str();
  room.add_option("--wand", options.wand, "the wand's markers, m along it, as 0,0.12,0.30 (default), or led: a single light");
  room.add_option("--frames", scene.frames, "length")->check(CLI::Range(1, 100'000'000))->capture_default_str();
  room.add_option("--rate", scene.rate_hz, "frames a second")->check(CLI::Range(1.0, 10000.0))->capture_default_str();
  room.add_option("--size", options.size, "of the pictures, px: width and height")
      ->check(CLI::Range(64, 8192))
      ->capture_default_str();
  room.add_option("--volume", options.volume, "that the cameras stand round, m: along x, y and z")
      ->check(CLI::Range(0.1, 1000.0))
      ->capture_default_str();
  room.add_option("--seed", scene.seed, "which of the endlessly many; the same one gives the same cameras for every motion")
      ->capture_default_str();
}

void add_troubles(CLI::App& room, SimulateRoom& options) {
  simulate::room::RoomOptions& scene = options.room;
  const CLI::Range share(0.0, 0.99);
  room.add_option("--noise", scene.noise_px, "standard deviation of a blob's place, px")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  room.add_option("--dropped", scene.dropped, "share of blobs that a camera misses")->check(share)->capture_default_str();
  room.add_option("--ghosts", scene.ghosts, "false blobs, as a share of the true ones")->check(share)->capture_default_str();
  room.add_option("--merge", scene.merge_px, "blobs nearer than this are seen as one, px")
      ->check(CLI::Range(0.0, 1000.0))
      ->capture_default_str();
  room.add_option("--gaps", scene.gap_share, "share of the time that a marker is covered for all cameras")
      ->check(CLI::Range(0.0, 0.25))
      ->capture_default_str();
  room.add_option("--gap-length", scene.gap_s, "the longest such time, s")->check(CLI::Range(0.01, 60.0))->capture_default_str();
  room.add_option("--offset", scene.offset_s, "cameras were started up to this much before or after the first, s")
      ->check(CLI::Range(0.0, 60.0))
      ->capture_default_str();
  room.add_option("--bump", options.bump,
                  "CAMERA,SECONDS,ANGLE: somebody runs into a camera (its number from 1), which turns by ANGLE rad");
  room.add_flag("!--no-occlusion", scene.occlusion, "limbs hide nothing");
  room.add_flag("--videos", options.files.videos, "render a video of each camera too");
}

}  // namespace

void add_simulate_room(CLI::App& simulate) {
  auto options = std::make_shared<SimulateRoom>();
  CLI::App* room = simulate.add_subcommand("room", "Markers in a room full of cameras: what each camera sees, and the exact truth");
  room->add_option("-o,--output", options->folder, "folder for the rig, the observations and their truth")->capture_default_str();
  add_scene(*room, *options);
  add_troubles(*room, *options);
  room->add_flag("-q,--quiet", options->quiet, "say nothing");
  room->callback([options] { run(*options); });
}

}  // namespace marey::cli
