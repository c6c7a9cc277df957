// A football match seen by six cameras that are known by homographies alone, each off by smooth errors: associations against a
// tracker of an afternoon, and the same with exact cameras.
//   disagreeing_homographies [--seeds N] [--seconds S] [--rate HZ]
#include <cstdint>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>

#include "marey/files/whole_file.h"
#include "marey/format/rig/rig_file.h"
#include "marey/pipeline/simulate/match_files.h"
#include "marey/simulate/match/match_homographies.h"

#include "ground_scene.h"

namespace marey::sweep {
namespace {

constexpr double kMinError = 0.25, kMaxError = 0.6;  // m, of each camera: two disagree by √2 times as much
constexpr double kMaxDistance = 1.5;                 // m from the truth, where a track counts: the truth's own frame is off

void use_homographies(const std::string& folder, std::uint64_t seed) {
  const Rig exact = format::rig::read_rig(folder + "/rig.toml");
  const Rig off = simulate::match::known_by_homographies(exact, {}, kMinError, kMaxError, seed);
  WholeFile file(folder + "/rig.toml");
  file.write(format::rig::rig_text(off));
  file.finish();
}

pipeline::people::ground::PeopleOnGroundOptions with(track::ground::GroundAssociation association, bool learns) {
  pipeline::people::ground::PeopleOnGroundOptions options;
  options.pitch = geometry::PitchSize{};
  options.tracker.associate = association;
  options.learn.agreement = options.learn.walk = learns;
  return options;
}

void run(int seeds, double seconds, double rate_hz) {
  using track::ground::GroundAssociation;
  print_titles();
  for (int seed = 1; seed <= seeds; ++seed) {
    const ScratchFolder folder;
    pipeline::simulate::MatchFilesOptions scene;
    scene.seconds = seconds;
    scene.cameras.rate_hz = rate_hz;
    scene.seed = static_cast<std::uint64_t>(seed);
    pipeline::simulate::write_match(scene, folder.path());
    for (const bool off : {false, true}) {
      if (off) use_homographies(folder.path(), scene.seed);
      const std::string cameras = off ? "off, " : "exact, ";
      print_scores(seed, cameras + "naive", run_naive(folder.path(), kMaxDistance));
      for (const auto& [name, association] : {std::pair("gnn", GroundAssociation::gnn), std::pair("mht", GroundAssociation::mht)}) {
        print_scores(seed, cameras + name + ", nothing learned", run_ours(folder.path(), with(association, false), kMaxDistance));
        print_scores(seed, cameras + name, run_ours(folder.path(), with(association, true), kMaxDistance));
      }
    }
  }
}

}  // namespace
}  // namespace marey::sweep

int main(int count, char** words) {
  int seeds = 2;
  double seconds = 90, rate_hz = 25;
  CLI::App app("A match, by cameras that are known by homographies");
  app.add_option("--seeds", seeds, "from 1 on")->capture_default_str();
  app.add_option("--seconds", seconds)->capture_default_str();
  app.add_option("--rate", rate_hz, "Hz")->capture_default_str();
  CLI11_PARSE(app, count, words);
  marey::sweep::run(seeds, seconds, rate_hz);
}
