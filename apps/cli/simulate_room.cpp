#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "marey/pipeline/simulate/room_files.h"

#include "command_line.h"
#include "commands.h"
#include "file_checks.h"
#include "json_value.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

struct SimulateRoom {
  simulate::room::RoomOptions room;
  pipeline::simulate::RoomFilesOptions files;
  std::string folder = "room";
  std::array<int, 2> size{1280, 1024};
  std::array<double, 3> volume{4, 4, 2.5};
  std::string wand;
  std::string bump;
  bool json = false;
  bool quiet = false;
};

std::vector<double> marker_positions_of(const std::string& text) {
  if (text == "led") return {0};
  std::vector<double> wand = numbers_in(text, ',', closed(-100, 100), "the markers' places in m, as 0,0.12,0.30, or led");
  if (std::adjacent_find(wand.begin(), wand.end(), std::greater_equal<>()) != wand.end())
    throw WrongUsage("{}: the places must grow", text);
  return wand;
}

simulate::room::RoomOptions::Bump bump_of(const std::string& text) {
  const char* form = "CAMERA,SECONDS,ANGLE: the camera's number from 1, when, and by how many rad";
  const std::vector<double> values = numbers_in(text, ',', closed(-1e5, 1e5), form);
  if (values.size() != 3 || values[0] < 1 || values[0] != std::floor(values[0])) throw WrongUsage("{}: write {}", text, form);
  return {.camera = static_cast<int>(values[0]) - 1, .time_s = values[1], .angle = values[2]};
}

bool scene_of_people(simulate::room::RoomMotion motion) {
  using enum simulate::room::RoomMotion;
  return motion != wand && motion != ground && motion != cloud;
}

simulate::room::RoomOptions room_of(const SimulateRoom& command) {
  simulate::room::RoomOptions room = command.room;
  room.image = {command.size[0], command.size[1]};
  room.volume = {command.volume[0], command.volume[1], command.volume[2]};
  if (!command.wand.empty()) room.wand = marker_positions_of(command.wand);
  if (!command.bump.empty()) room.bump = bump_of(command.bump);
  const bool people = scene_of_people(room.motion);
  if (!people && (room.actors > 1 || room.skin_m > 0))
    throw WrongUsage("{}", "--actors and --soft-tissue are of people: give a --motion of theirs");
  if (!people && command.files.keypoints) throw WrongUsage("{}", "--keypoints: of people; give a --motion of theirs");
  if (room.bump && room.bump->camera >= room.cameras)
    throw WrongUsage("--bump {}: there are {} cameras", command.bump, room.cameras);
  return room;
}

void run(const SimulateRoom& command) {
  const simulate::room::RoomScene scene(room_of(command));
  make_folder(command.folder);
  with_progress(command.quiet,
                [&](const Hooks& hooks) { pipeline::simulate::write_room(scene, command.folder, command.files, hooks); });
  if (command.json)
    print({{"cameras", scene.rig().cameras.size()},
           {"markers", scene.labels().size()},
           {"frames", scene.options().frames},
           {"rate_hz", scene.options().rate_hz},
           {"seed", scene.options().seed},
           {"folder", command.folder}});
  if (command.quiet || command.json) return;
  fmt::print(stderr,
             "{} cameras, {} markers, {} frames at {} Hz\n{}: rig.toml (the truth), start.toml, observations.csv, blobs.csv, "
             "truth.csv{}{}\n",
             scene.rig().cameras.size(), scene.labels().size(), scene.options().frames, scene.options().rate_hz, command.folder,
             command.files.keypoints ? ", keypoints_CAMERA.json, keypoints_truth.csv" : "",
             command.files.videos ? ", and a video of each camera" : "");
}

void add_scene(Command& room, SimulateRoom& options) {
  simulate::room::RoomOptions& scene = options.room;
  std::vector<std::pair<std::string, simulate::room::RoomMotion>> motions;
  for (const simulate::room::NamedRoomMotion& known : simulate::room::room_motions())
    motions.emplace_back(known.name, known.motion);
  room.choice(
      "--motion", scene.motion, motions,
      "a person with markers who walks, runs, waves, kneels down, rolls on the floor or stands still; a wand that is waved; an "
      "L-frame on the ground; a cloud of free markers");
  room.whole("--cameras", scene.cameras, "N", 1, 256, "how many, round the volume");
  room.whole("--markers", scene.markers, "N", 1, 2000, "how many, on each body or free");
  room.whole("--actors", scene.actors, "N", 1, 20, "people who do the same, apart from each other");
  room.whole("--rigid-bodies", scene.props, "N", 0, 200, "rigid bodies of five markers that fly through the volume");
  room.number("--soft-tissue", scene.skin_m, "m", closed(0, 0.1),
              "how far a thigh's skin carries its markers at a bend of 90°; other limbs' less");
  room.text("--wand", options.wand, "the wand's markers, m along it, as 0,0.12,0.30 (default), or led: a single light")
      .check(marker_positions_of);
  room.whole("--frames", scene.frames, "N", 1, 100'000'000, "length");
  room.number("--rate", scene.rate_hz, "Hz", closed(1, 10000), "frames a second");
  room.wholes("--size", options.size, "px", 64, 8192, "of the images: width and height");
  room.number("--zoom", scene.zoom, "x", closed(0.1, 20), "times the focal length of a lens that sees 66° across");
  room.numbers("--volume", options.volume, "m", closed(0.1, 1000), "that the cameras stand round: along x, y and z");
  room.seed(scene.seed, "which of the endlessly many; the same one gives the same cameras for every motion");
}

void add_troubles(Command& room, SimulateRoom& options) {
  simulate::room::RoomOptions& scene = options.room;
  room.number("--noise", scene.noise_px, "px", closed(0, 100), "standard deviation of a blob's place");
  room.number("--miss-rate", scene.dropped, "fraction", closed(0, 0.99), "of blobs that a camera misses");
  room.number("--ghosts", scene.ghosts, "fraction", closed(0, 0.99), "false blobs, of the true ones");
  room.number("--merge", scene.merge_px, "px", closed(0, 1000), "blobs nearer than this are seen as one");
  room.number("--gaps", scene.gap_fraction, "fraction", closed(0, 0.25), "of the time that a marker is covered for all cameras");
  room.number("--gap-length", scene.gap_s, "s", closed(0.01, 60), "the longest such time");
  room.number("--offset", scene.offset_s, "s", closed(0, 60), "cameras were started up to this much before or after the first");
  room.text("--bump", options.bump,
            "CAMERA,SECONDS,ANGLE: a person runs into a camera (its number from 1), which turns by ANGLE rad")
      .check(bump_of);
  room.flag("--no-occlusion", scene.occlusion, "limbs hide nothing", false);
  room.flag("--unnamed", options.files.unnamed, "the points without names too, as tracks that end at gaps, with ghosts among them");
  room.flag("--keypoints", options.files.keypoints,
            "people's body keypoints with a network's errors: keypoints_CAMERA.json (COCO) and keypoints_truth.csv");
  room.number("--swapped", options.files.keypoint_errors.swapped, "fraction", closed(0, 0.99),
              "of time during which arms, or legs, are exchanged in a camera's keypoints");
  room.number("--drift", options.files.keypoint_errors.drift, "fraction", closed(0, 0.001),
              "by which cameras' clocks run slower or faster than the first one's at most, in keypoints: 25e-6 is 25 ppm");
  room.number("--rolling-shutter", options.files.keypoint_errors.readout_s, "s", closed(0, 0.1),
              "from the exposure of the image's first row to that of the last one, in keypoints: phones have 0.01 to 0.03");
  room.flag("--render", options.files.videos, "render a video of each camera too");
}

}  // namespace

void add_simulate_room(Command& simulate) {
  auto options = std::make_shared<SimulateRoom>();
  Command command = simulate.subcommand("room", "Markers in a room full of cameras: what each camera sees, and the exact truth");
  command.output_folder("-o,--output", options->folder, "folder for the rig, the observations and their truth");
  add_scene(command, *options);
  add_troubles(command, *options);
  command.reports(options->json, options->quiet);
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli
