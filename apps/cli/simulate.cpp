#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/core.h>

#include "marey/core/error.h"
#include "marey/pipeline/simulation_files.h"
#include "marey/simulate/markers/marker_scene.h"

#include "commands.h"

namespace marey::cli {
namespace {

struct SimulateMarkers {
  std::string situation;
  std::string folder;
  std::uint64_t seed = 1;
  simulate::markers::MarkerSceneOptions scene;
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
  throw Error("there is no situation \"{}\"; there are: {}", name, situation_names());
}

void run(const SimulateMarkers& command) {
  const std::filesystem::path folder =
      command.folder.empty() ? command.situation + "_" + std::to_string(command.seed) : command.folder;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Error("{}: the folder cannot be made ({})", folder.string(), error.message());
  const simulate::markers::MarkerScene scene =
      simulate::markers::simulate_markers(situation_of(command.situation), command.seed, command.scene);
  const std::string video = (folder / "video.mp4").string(), truth = (folder / "truth.csv").string();
  pipeline::film_markers(scene, video);
  pipeline::write_marker_truth(scene, truth);
  if (command.quiet) return;
  fmt::print(stderr, "{} frames, {} {}\nvideo: {}\ntruth: {}\n", scene.frames.size(), scene.frames.front().size(),
             scene.frames.front().size() == 1 ? "marker" : "markers", video, truth);
}

}  // namespace

void add_simulate(CLI::App& app) {
  CLI::App* simulate = app.add_subcommand("simulate", "Make a video whose truth is known");
  simulate->require_subcommand(1);
  auto options = std::make_shared<SimulateMarkers>();
  CLI::App* markers =
      simulate->add_subcommand("markers", "Bright markers on a dark ground, in a situation that makes trackers fail");
  markers->add_option("SITUATION", options->situation, "one of " + situation_names())
      ->required()
      ->check(CLI::Validator(
          [](std::string& text) -> std::string {
            try {
              situation_of(text);
              return "";
            } catch (const Error& error) {
              return error.what();
            }
          },
          ""));
  markers->add_option("-o,--output", options->folder, "folder for video.mp4 and truth.csv (default: SITUATION_SEED, here)");
  markers->add_option("--seed", options->seed, "which of the endlessly many videos")->capture_default_str();
  markers->add_option("--frames", options->scene.frames, "length (default: as long as the paper's)")
      ->check(CLI::Range(2, 1'000'000));
  markers->add_option("--markers", options->scene.markers, "how many markers; those beyond the situation's own move plainly")
      ->check(CLI::Range(1, 2000));
  markers->add_option("--radius", options->scene.radius_px, "of each marker, px")
      ->check(CLI::Range(0.5, 60.0))
      ->capture_default_str();
  markers->add_option("--blur", options->scene.blur_px, "of its edge, px")->check(CLI::Range(0.05, 20.0))->capture_default_str();
  markers->add_option("--noise", options->scene.noise, "standard deviation of the pixels, grey levels")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  markers->add_option("--clutter", options->scene.clutter, "false lights in each frame")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  markers->add_flag("-q,--quiet", options->quiet, "say nothing");
  markers->callback([options] { run(*options); });
  add_simulate_people(*simulate);
  add_simulate_room(*simulate);
  add_simulate_match(*simulate);
}

}  // namespace marey::cli
