// Inverse kinematics of a whole person, a frame at a time, on one core: 33 coordinates and 64 markers as of the model of Arnold et
// al., walking. Published: OpenSim 27 ms on this model, SmoCap 0.20 to 0.33 ms on its own. Counters: the time that 99 of 100 frames
// keep (CPU time), and how near the markers come.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "marey/format/skeleton/motion_table.h"
#include "marey/format/skeleton/skeleton_file.h"
#include "marey/solve/skeleton/pose_solver.h"

namespace {

using namespace marey;

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// The model and its walk, σ m of noise on every marker: by angles of the file, so that the truth is known.
struct Walk {
  Skeleton skeleton;
  std::vector<std::vector<std::optional<Vector<3>>>> detected;
};

Walk walk(double sigma_m) {
  const char* given = std::getenv("MAREY_DATA");
  const std::string folder = std::string(given != nullptr ? given : "../shared/data") + "/arnold_synthetic/subject01/";
  if (!std::filesystem::exists(folder)) return {};
  Walk result{format::skeleton::read_skeleton(folder + "scaled.osim").skeleton, {}};
  const auto motion =
      format::skeleton::motion_of(format::skeleton::read_motion_table(folder + "coordinates.sto"), result.skeleton, false);
  std::uint64_t random = 1;
  const auto noise = [&] {
    double sum = -6;
    for (int i = 0; i < 12; ++i) {
      random = random * 6364136223846793005ULL + 1442695040888963407ULL;
      sum += static_cast<double>(random >> 11) / 9007199254740992.0;
    }
    return sigma_m * sum;
  };
  for (std::vector<double> row : motion.rows) {
    result.skeleton.couple(row);
    const auto pose = pose_of(result.skeleton, row);
    auto& detected = result.detected.emplace_back();
    for (const SkeletonMarker& marker : result.skeleton.markers)
      detected.emplace_back(pose[static_cast<std::size_t>(marker.segment)] * marker.position +
                            Vector<3>(noise(), noise(), noise()));
  }
  return result;
}

void solve_frames(benchmark::State& state) {
  const Walk walked = walk(static_cast<double>(state.range(0)) * 1e-3);
  if (walked.detected.empty()) {
    state.SkipWithError("arnold_synthetic is not here; MAREY_DATA says where");
    return;
  }
  std::vector<double> times;
  double rms = 0;
  for (auto _ : state) {
    solve::skeleton::PoseSolver solver(walked.skeleton);
    for (std::size_t f = 0; f < walked.detected.size(); ++f) {
      const double begin = cpu_seconds();
      const auto& pose = solver.step(1 / 200.0, walked.detected[f]);
      if (f > 0) times.push_back(cpu_seconds() - begin);  // the first starts from nothing
      rms = pose.rms_m;
    }
  }
  std::sort(times.begin(), times.end());
  state.counters["median_ms"] = 1000 * times[times.size() / 2];
  state.counters["p99_ms"] = 1000 * times[times.size() * 99 / 100];
  state.counters["rms_mm"] = 1000 * rms;
  state.counters["coordinates"] = static_cast<double>(walked.skeleton.coordinates.size());
  state.counters["markers"] = static_cast<double>(walked.skeleton.markers.size());
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(walked.detected.size()));
}
BENCHMARK(solve_frames)->ArgName("noise_mm")->Arg(0)->Arg(1)->Arg(5)->Unit(benchmark::kMillisecond);

}  // namespace
