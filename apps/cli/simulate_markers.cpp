#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/core.h>

#include "marey/pipeline/corridor/simulation_files.h"
#include "marey/simulate/markers/marker_scene.h"

#include "command_line.h"
#include "commands.h"
#include "file_checks.h"
#include "json_value.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

struct SimulateMarkers {
  std::string name;
  std::string folder;
  std::uint64_t seed = 1;
  simulate::markers::MarkerSceneOptions scene;
  bool json = false;
  bool quiet = false;
};

std::string situation_names() {
  std::string names;
  for (const simulate::markers::NamedSituation& known : simulate::markers::marker_situations())
    names.append(names.empty() ? "" : ", ").append(known.name);
  return names;
}

simulate::markers::MarkerSituation situation_of(const std::string& name) {
  for (const simulate::markers::NamedSituation& known : simulate::markers::marker_situations()) {
    if (known.name == name) return known.situation;
  }
  throw WrongUsage("there is no situation \"{}\"; there are: {}", name, situation_names());
}

void run(const SimulateMarkers& command) {
  const std::filesystem::path folder = command.folder.empty() ? command.name + "_" + std::to_string(command.seed) : command.folder;
  make_folder(folder.string());
  const simulate::markers::MarkerScene scene =
      simulate::markers::simulate_markers(situation_of(command.name), command.seed, command.scene);
  with_progress(command.quiet, [&](const Hooks& hooks) { pipeline::corridor::write_markers(scene, folder.string(), hooks); });
  const std::string video = (folder / "video.mp4").string(), truth = (folder / "truth.csv").string();
  const std::size_t frames = scene.frames.size(), markers = scene.frames.front().size();
  if (command.json) {
    print({{"frames", frames}, {"markers", markers}, {"seed", command.seed}, {"video", video}, {"truth", truth}});
  } else if (!command.quiet) {
    fmt::print(stderr, "{} frames, {} {}\nvideo: {}\ntruth: {}\n", frames, markers, markers == 1 ? "marker" : "markers", video,
               truth);
  }
}

}  // namespace

void add_simulate_markers(Command& simulate) {
  auto options = std::make_shared<SimulateMarkers>();
  Command command = simulate.subcommand("markers", "Bright markers on a dark ground, in a situation that makes trackers fail");
  command.text("SITUATION", options->name, "one of " + situation_names()).required().check(situation_of);
  command.output_folder("-o,--output", options->folder, "folder for video.mp4 and truth.csv (default: SITUATION_SEED, here)");
  command.seed(options->seed, "which of the endlessly many videos");
  command.whole("--frames", options->scene.frames, "N", 2, 1'000'000, "length (default: as long as the paper's)");
  command.whole("--markers", options->scene.markers, "N", 1, 2000, "how many; those beyond the situation's own move plainly");
  command.number("--radius", options->scene.radius_px, "px", closed(0.5, 60), "of each marker");
  command.number("--blur", options->scene.blur_px, "px", closed(0.05, 20), "of its edge");
  command.number("--noise", options->scene.noise, "grey levels", closed(0, 100), "standard deviation of the pixels");
  command.whole("--clutter", options->scene.clutter, "N", 0, 1000, "false lights in each frame");
  command.reports(options->json, options->quiet);
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli
