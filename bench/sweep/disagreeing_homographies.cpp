// A football match seen by six cameras that are known by homographies alone, each off by smooth errors: associations against a
// tracker of an afternoon, and the same with exact cameras.
//   disagreeing_homographies [SEEDS] [SECONDS] [RATE_HZ]
#include <cstdlib>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "marey/core/whole_file.h"
#include "marey/format/rig/rig_file.h"
#include "marey/pipeline/match_files.h"
#include "marey/simulate/match/match_homographies.h"

#include "ground_scene.h"

namespace marey::sweep {
namespace {

constexpr double kLeast = 0.25, kMost = 0.6;  // m, of each camera: two disagree by √2 times as much
constexpr double kFarthest = 1.5;             // m from the truth, where a track counts: the truth's own frame is off

void use_homographies(const std::string& folder, std::uint64_t seed) {
  const Rig exact = format::rig::read_rig(folder + "/rig.toml");
  const Rig off = simulate::match::known_by_homographies(exact, {}, kLeast, kMost, seed);
  WholeFile file(folder + "/rig.toml");
  file.write(format::rig::rig_text(off));
  file.finish();
}

pipeline::PeopleOnGroundOptions with(track::ground::GroundAssociation association, bool learns) {
  pipeline::PeopleOnGroundOptions options;
  options.pitch = geometry::PitchSize{};
  options.tracker.associate = association;
  options.learn.agreement = options.learn.walk = learns;
  return options;
}

void run(int seeds, double seconds, double rate_hz) {
  using track::ground::GroundAssociation;
  fmt::print("match of {} s at {} Hz, six cameras, each off by {} to {} m\n", seconds, rate_hz, kLeast, kMost);
  for (int seed = 1; seed <= seeds; ++seed) {
    const ScratchFolder folder;
    pipeline::MatchFilesOptions scene;
    scene.seconds = seconds;
    scene.cameras.rate_hz = rate_hz;
    scene.seed = static_cast<std::uint64_t>(seed);
    pipeline::write_match(scene, folder.path());
    fmt::print("seed {}\n", seed);
    for (const bool off : {false, true}) {
      if (off) use_homographies(folder.path(), scene.seed);
      const std::string cameras = off ? "off, " : "exact, ";
      print_scores(cameras + "naive", run_naive(folder.path(), kFarthest));
      for (const auto& [name, association] : {std::pair("gnn", GroundAssociation::gnn), std::pair("mht", GroundAssociation::mht)}) {
        print_scores(cameras + name + " as it was", run_ours(folder.path(), with(association, false), kFarthest));
        print_scores(cameras + name, run_ours(folder.path(), with(association, true), kFarthest));
      }
    }
  }
}

}  // namespace
}  // namespace marey::sweep

int main(int argc, char** argv) {
  marey::sweep::run(argc > 1 ? std::atoi(argv[1]) : 2, argc > 2 ? std::atof(argv[2]) : 90, argc > 3 ? std::atof(argv[3]) : 25);
}
