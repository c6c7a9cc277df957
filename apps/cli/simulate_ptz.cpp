#include "simulate_ptz.h"

#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <fmt/core.h>

#include "marey/pipeline/simulate/ptz_files.h"
#include "marey/simulate/match/ptz_scenes.h"

#include "command_line.h"
#include "file_checks.h"
#include "json_value.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

struct SimulatePtz {
  pipeline::simulate::PtzFilesOptions files;
  std::string folder;
  std::array<int, 2> size{1280, 720};
  std::string scene = "plain";
  std::optional<double> exposure, noise, cut_at, graphics_at;
  bool json = false;
  bool quiet = false;
};

constexpr double kCutSeconds = 2, kGraphicsSeconds = 4;

void run(const SimulatePtz& command) {
  pipeline::simulate::PtzFilesOptions options = command.files;
  const double rate = options.match.rate_hz;
  options.match = simulate::match::ptz_scene(command.scene);
  options.match.rate_hz = rate;
  options.match.exposure = command.exposure.value_or(options.match.exposure);
  options.match.noise = command.noise.value_or(options.match.noise);
  options.match.size = {command.size[0], command.size[1]};
  if (command.cut_at) options.match.cuts = {{*command.cut_at, *command.cut_at + kCutSeconds}};
  if (command.graphics_at) options.match.graphics = {{*command.graphics_at, *command.graphics_at + kGraphicsSeconds}};
  make_folder(command.folder);
  with_progress(command.quiet, [&](const Hooks& hooks) { pipeline::simulate::write_ptz_match(options, command.folder, hooks); });
  if (command.json)
    print({{"folder", command.folder},
           {"rig", (std::filesystem::path(command.folder) / "rig.toml").string()},
           {"seconds", options.seconds},
           {"seed", options.seed}});
  if (command.quiet || command.json) return;
  fmt::print(stderr, "{}: main.mp4, clicks.csv, boxes.txt; rig.toml (the exact camera) and truth.csv (where every person is)\n",
             command.folder);
}

}  // namespace

void add_simulate_ptz(Command& simulate) {
  auto options = std::make_shared<SimulatePtz>();
  Command command = simulate.subcommand("ptz", "A football match recorded by one camera that pans, tilts and zooms after the play");
  command.output_folder("-o,--output", options->folder, "folder for the video, clicks, boxes and their truth").required();
  command.number("--seconds", options->files.seconds, "s", closed(0.001, 10800), "length");
  command.seed(options->files.seed, "which of the endlessly many matches");
  command.wholes("--size", options->size, "px", 64, 8192, "of the images: width and height");
  command.number("--rate", options->files.match.rate_hz, "Hz", closed(0.1, 1000), "frames a second");
  command.number("--exposure", options->exposure, "s", closed(0, 0.1),
                 "of each frame: how long motion smears (default: the scene's)");
  command.number("--noise", options->noise, "grey levels", closed(0, 50),
                 "standard deviation of the pixels (default: the scene's)");
  command.number("--cut", options->cut_at, "s", closed(0, 10800),
                 "at this time another camera is shown, for two seconds (default: never)");
  command.number("--graphics", options->graphics_at, "s", closed(0, 10800),
                 "at this time the lower half of the image is covered, for four seconds (default: never)");
  command
      .text("--scene", options->scene,
            "plain, whip, thin, wet, worn, extra, low, near, mats, junior, screen, hockey or all: what makes the lines hard to "
            "follow")
      .check(simulate::match::ptz_scene);
  command.number("--click-noise", options->files.click_noise, "px", closed(0, 100), "standard deviation of the clicks");
  command.number("--clicked-from", options->files.clicked_from, "s", closed(0, 10800), "no frame before is clicked");
  command.whole("--clicked-frames", options->files.clicked_frames, "frames", 0, 100, "that are clicked, at most");
  command.whole("--clicks", options->files.clicks, "clicks", 4, 100, "in a frame, at most");
  command.reports(options->json, options->quiet);
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli
