// An open square with people who come and leave at every side, seen by seven cameras: ours against a tracker of an afternoon.
//   open_square [--seeds N] [--rate HZ]
#include <cstdint>

#include <CLI/CLI.hpp>

#include "marey/pipeline/simulate/square_files.h"

#include "ground_scene.h"

namespace marey::sweep {
namespace {

void run(int seeds, double rate_hz) {
  pipeline::simulate::SquareFilesOptions scene;
  scene.rate_hz = rate_hz;
  print_titles();
  for (int seed = 1; seed <= seeds; ++seed) {
    const ScratchFolder folder;
    scene.seed = static_cast<std::uint64_t>(seed);
    pipeline::simulate::write_square(scene, folder.path());
    print_scores(seed, "naive", run_naive(folder.path()));
    pipeline::people::ground::PeopleOnGroundOptions quick;
    quick.tracker.associate = track::ground::GroundAssociation::gnn;
    print_scores(seed, "gnn", run_ours(folder.path(), quick));
    pipeline::people::ground::PeopleOnGroundOptions late;
    late.tracker.associate = track::ground::GroundAssociation::mht;
    late.tracker.window = 2;
    print_scores(seed, "mht", run_ours(folder.path(), late));
  }
}

}  // namespace
}  // namespace marey::sweep

int main(int count, char** words) {
  int seeds = 3;
  double rate_hz = 2;
  CLI::App app("People on an open square");
  app.add_option("--seeds", seeds, "from 1 on")->capture_default_str();
  app.add_option("--rate", rate_hz, "Hz")->capture_default_str();
  CLI11_PARSE(app, count, words);
  marey::sweep::run(seeds, rate_hz);
}
