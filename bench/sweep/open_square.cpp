// An open square with people who come and leave at every side, seen by seven cameras: ours against a tracker of an afternoon.
//   open_square [SEEDS] [RATE_HZ]
#include <cstdlib>
#include <string>

#include <fmt/core.h>

#include "marey/pipeline/square_files.h"

#include "ground_scene.h"

namespace marey::sweep {
namespace {

void run(int seeds, double rate_hz) {
  pipeline::SquareFilesOptions scene;
  scene.rate_hz = rate_hz;
  fmt::print("square {} x {} m, {} cameras, {} Hz, {} s, {:.2f} groups a second, missed {:.2f}, noise {:.2f}\n",
             scene.square.length, scene.square.width, scene.cameras, rate_hz, scene.seconds, scene.square.arrivals,
             scene.detector.missed, scene.detector.size_noise);
  double ours = 0, naive = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    const ScratchFolder folder;
    scene.seed = static_cast<std::uint64_t>(seed);
    pipeline::write_square(scene, folder.path());
    fmt::print("seed {}\n", seed);
    const GroundScores peer = run_naive(folder.path());
    print_scores("naive", peer);
    pipeline::PeopleOnGroundOptions quick;
    quick.tracker.associate = track::ground::GroundAssociation::gnn;
    print_scores("gnn", run_ours(folder.path(), quick));
    pipeline::PeopleOnGroundOptions late;
    late.tracker.associate = track::ground::GroundAssociation::mht;
    late.tracker.window = 2;
    const GroundScores own = run_ours(folder.path(), late);
    print_scores("mht", own);
    ours += own.idf1 / seeds;
    naive += peer.idf1 / seeds;
  }
  fmt::print("mean IDF1: naive {:.3f}, mht {:.3f}\n", naive, ours);
}

}  // namespace
}  // namespace marey::sweep

int main(int argc, char** argv) {
  marey::sweep::run(argc > 1 ? std::atoi(argv[1]) : 3, argc > 2 ? std::atof(argv[2]) : 2);
}
