#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "marey/core/error.h"
#include "marey/pipeline/corridor/simulation_files.h"
#include "marey/source/open_source.h"

#include "command_line.h"
#include "commands.h"
#include "file_checks.h"
#include "json_value.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

struct SimulatePeople {
  simulate::people::PeopleSituation situation = simulate::people::PeopleSituation::crowd;
  std::string folder = "people";
  std::string ground;
  std::uint64_t seed = 1;
  simulate::people::PeopleVideoOptions video;
  std::array<int, 2> size{768, 576};
  bool json = false;
  bool quiet = false;
};

Image image_of(const std::string& path) {
  auto frame = source::open_source(path)->next();
  if (!frame) throw Error("{}: no image could be read", path);
  return frame->image;
}

/// Where others than those asked for are in the video.
std::vector<std::string> reported_of(const SimulatePeople& command, const simulate::people::PeopleVideo& video) {
  const int there = video.max_at_a_time();
  if (!command.video.people || *command.video.people == there) return {};
  using Situation = simulate::people::PeopleSituation;
  if (command.situation == Situation::crossing || command.situation == Situation::overlap)
    return {fmt::format("this situation is of {} people; --people {} is for the others", there, *command.video.people)};
  return {fmt::format("{} of {} people have room to keep apart in {} x {} px: a smaller --height or a larger --size makes more",
                      there, *command.video.people, command.size[0], command.size[1])};
}

std::vector<std::string> files_of(const SimulatePeople& command) {
  std::vector<std::string> files;
  for (const char* name : {"video.mp4", "rig.toml", "truth.txt", "positions.csv", "silhouettes.jsonl"})
    files.push_back((std::filesystem::path(command.folder) / name).string());
  return files;
}

void run(const SimulatePeople& command) {
  simulate::people::PeopleVideoOptions options = command.video;
  options.size = {command.size[0], command.size[1]};
  if (!command.ground.empty()) options.ground = image_of(command.ground);
  const simulate::people::PeopleVideo video(command.situation, command.seed, options);
  const std::vector<std::string> warnings = reported_of(command, video);
  warn(warnings);
  make_folder(command.folder);
  with_progress(command.quiet, [&](const Hooks& hooks) { pipeline::corridor::video_people(video, command.folder, hooks); });
  if (command.json)
    print({{"frames", video.frames()},
           {"people", video.figures().size()},
           {"seed", command.seed},
           {"warnings", warnings},
           {"folder", command.folder},
           {"files", files_of(command)}});
  if (command.quiet || command.json) return;
  fmt::print(stderr, "{} frames, {} {}\n{}: video.mp4, rig.toml, truth.txt, positions.csv, silhouettes.jsonl\n", video.frames(),
             video.figures().size(), video.figures().size() == 1 ? "person" : "people", command.folder);
}

}  // namespace

void add_simulate_people(Command& simulate) {
  auto options = std::make_shared<SimulatePeople>();
  Command command = simulate.subcommand("people", "People who walk and run before a fixed camera, with their exact silhouettes");
  using simulate::people::LightChange;
  std::vector<std::pair<std::string, simulate::people::PeopleSituation>> situations;
  for (const simulate::people::NamedPeopleSituation& known : simulate::people::people_situations())
    situations.emplace_back(known.name, known.situation);
  constexpr std::array<std::pair<const char*, LightChange>, 3> kLights{
      {{"steady", LightChange::constant}, {"gradual", LightChange::gradual}, {"sudden", LightChange::sudden}}};
  simulate::people::PeopleVideoOptions& video = options->video;
  command.choice("--situation", options->situation, situations, "what they do");
  command.output_folder("-o,--output", options->folder, "folder for the video and its truth");
  command.also_writes([options] { return files_of(*options); });
  command.seed(options->seed, "which of the endlessly many videos");
  command.whole("--frames", video.frames, "N", 1, 1'000'000, "length (default: 100 of crossing, 200 of the others)");
  command.number("--rate", video.rate_hz, "Hz", closed(1, 1000), "frames a second");
  command.wholes("--size", options->size, "px", 32, 8192, "of the image: width and height");
  command.whole("--people", video.people, "N", 0, 1000, "how many at a time (default: 2 of crossing and post, 6 of the others)");
  command.number("--height", video.height_px, "px", closed(4, 4000), "of a person in the middle of the image");
  command.number("--speed-factor", video.pace, "factor", closed(0.05, 5), "on every person's speed");
  command.number("--noise", video.noise, "grey levels", closed(0, 50), "standard deviation of the pixels");
  command.choice("--light", video.light, kLights, "how it changes");
  command.number(
      "--shake", video.shake_px, "px", closed(0, 50),
      "the camera shakes in wind and by steps: how far the image moves, root mean square; the truth is that of its rest");
  command.input_file("--background-image", options->ground,
                     "image of the empty scene, or a video whose first frame shows it (default: a lawn)");
  command.number("--max-occlusion", video.hidden_s, "s", closed(0.1, 10), "post: the longest time that a person is hidden");
  command.flag("--own-clothes", video.own_clothes, "every person in clothes of their own (default: two teams in two shirts)", true);
  command.flag("--no-shadows", video.shadows, "the sun casts none", false);
  command.reports(options->json, options->quiet);
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli
