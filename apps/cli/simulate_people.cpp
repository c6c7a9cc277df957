#include <array>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include <fmt/core.h>

#include "marey/core/error.h"
#include "marey/pipeline/simulation_files.h"
#include "marey/source/open_source.h"

#include "choice.h"
#include "commands.h"
#include "progress_bar.h"

namespace marey::cli {
namespace {

struct SimulatePeople {
  simulate::people::PeopleSituation situation = simulate::people::PeopleSituation::crowd;
  std::string folder = "people";
  std::string ground;
  std::uint64_t seed = 1;
  simulate::people::PeopleFilmOptions film;
  std::array<int, 2> size{768, 576};
  bool quiet = false;
};

Picture picture_of(const std::string& path) {
  auto frame = source::open_source(path)->next();
  if (!frame) throw Error("{}: no picture could be read", path);
  return frame->picture;
}

void run(const SimulatePeople& command) {
  simulate::people::PeopleFilmOptions options = command.film;
  options.size = {command.size[0], command.size[1]};
  if (!command.ground.empty()) options.ground = picture_of(command.ground);
  const simulate::people::PeopleFilm film(command.situation, command.seed, options);
  std::error_code error;
  std::filesystem::create_directories(command.folder, error);
  if (error) throw Error("{}: the folder cannot be made ({})", command.folder, error.message());
  {
    ProgressBar bar(command.quiet);
    pipeline::film_people(film, command.folder, [&](int done, int all) { bar.show("frames", done, all); });
  }
  if (command.quiet) return;
  fmt::print(stderr, "{} frames, {} {}\n{}: video.mp4, truth.txt, positions.csv, silhouettes.jsonl\n", film.frames(),
             film.figures().size(), film.figures().size() == 1 ? "person" : "people", command.folder);
}

}  // namespace

void add_simulate_people(CLI::App& simulate) {
  auto options = std::make_shared<SimulatePeople>();
  CLI::App* people =
      simulate.add_subcommand("people", "People who walk and run before a fixed camera, with their exact silhouettes");
  std::map<std::string, simulate::people::PeopleSituation> situations;
  for (const simulate::people::NamedPeopleSituation& known : simulate::people::people_situations())
    situations.emplace(known.name, known.situation);
  const std::map<std::string, simulate::people::LightChange> lights{{"steady", simulate::people::LightChange::steady},
                                                                    {"gradual", simulate::people::LightChange::gradual},
                                                                    {"sudden", simulate::people::LightChange::sudden}};
  simulate::people::PeopleFilmOptions& film = options->film;
  add_choice(*people, "--situation", options->situation, situations, "what they do")->default_str("crowd");
  people->add_option("-o,--output", options->folder, "folder for the video and its truth")->capture_default_str();
  people->add_option("--seed", options->seed, "which of the endlessly many films")->capture_default_str();
  people->add_option("--frames", film.frames, "length (default: 100 of crossing, 200 of the others)")
      ->check(CLI::Range(1, 1'000'000));
  people->add_option("--rate", film.rate_hz, "frames a second")->check(CLI::Range(1.0, 1000.0))->capture_default_str();
  people->add_option("--size", options->size, "of the picture, px: width and height")
      ->check(CLI::Range(32, 8192))
      ->capture_default_str();
  people->add_option("--people", film.people, "how many at a time (default: 2 of crossing and post, 6 of the others)")
      ->check(CLI::Range(0, 1000));
  people->add_option("--height", film.height_px, "of a person in the middle of the picture, px")
      ->check(CLI::Range(4.0, 4000.0))
      ->capture_default_str();
  people->add_option("--pace", film.pace, "factor on everybody's speed")->check(CLI::Range(0.05, 5.0))->capture_default_str();
  people->add_option("--noise", film.noise, "standard deviation of the pixels, grey levels")
      ->check(CLI::Range(0.0, 50.0))
      ->capture_default_str();
  add_choice(*people, "--light", film.light, lights, "how it changes")->default_str("steady");
  people->add_option("--shake", film.shake_px, "standard deviation of the camera's shaking, px")
      ->check(CLI::Range(0.0, 50.0))
      ->capture_default_str();
  people->add_option("--ground", options->ground,
                     "picture of the empty scene, or a video whose first frame shows it (default: a lawn)");
  people->add_option("--hidden", film.hidden_s, "post: the longest time that somebody is hidden, s")
      ->check(CLI::Range(0.1, 10.0))
      ->capture_default_str();
  people->add_flag("!--no-shadows", film.shadows, "the sun casts none");
  people->add_flag("-q,--quiet", options->quiet, "say nothing");
  people->callback([options] { run(*options); });
}

}  // namespace marey::cli
