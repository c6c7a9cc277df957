#include <filesystem>
#include <memory>
#include <string>

#include <fmt/core.h>

#include "marey/pipeline/simulate/square_files.h"

#include "command_line.h"
#include "commands.h"
#include "file_checks.h"
#include "json_value.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

struct SimulateSquare {
  pipeline::simulate::SquareFilesOptions files;
  std::string folder;
  bool json = false;
  bool quiet = false;
};

void run(const SimulateSquare& command) {
  make_folder(command.folder);
  with_progress(command.quiet, [&](const Hooks& hooks) { pipeline::simulate::write_square(command.files, command.folder, hooks); });
  if (command.json)
    print({{"folder", command.folder},
           {"rig", (std::filesystem::path(command.folder) / "rig.toml").string()},
           {"truth", (std::filesystem::path(command.folder) / "truth.csv").string()},
           {"seconds", command.files.seconds},
           {"seed", command.files.seed}});
  if (command.quiet || command.json) return;
  fmt::print(stderr, "{}: rig.toml (the exact cameras), truth.csv (where every person is), the boxes that each camera sees\n",
             command.folder);
}

}  // namespace

void add_simulate_square(Command& simulate) {
  auto options = std::make_shared<SimulateSquare>();
  Command command = simulate.subcommand(
      "square", "An open square, 36 by 12 m: people who come and leave at every side by the hundred, and what cameras see of them");
  command.output_folder("-o,--output", options->folder, "folder for the rig, the boxes and their truth").required();
  command.number("--seconds", options->files.seconds, "s", closed(0.001, 86400), "length");
  command.seed(options->files.seed, "which of the endlessly many squares");
  command.number("--rate", options->files.rate_hz, "Hz", closed(0.1, 1000), "frames a second");
  command.whole("--cameras", options->files.cameras, "N", 1, 64, "how many round the square");
  command.number("--arrivals", options->files.square.arrivals, "Hz", closed(0.01, 10),
                 "groups of one to four that come, per second");
  command.number("--miss-rate", options->files.detector.missed, "fraction", closed(0, 1),
                 "of people in view that a camera's detector misses");
  command.number("--size-noise", options->files.detector.size_noise, "fraction", closed(0, 1),
                 "standard deviation of each edge of a box, of its size");
  command.reports(options->json, options->quiet);
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli
