// Hypotheses beside what decides at once. Relevant figures:
//   k_best        `against_one`: the k best answers over the time of the best one alone, by the same gates; k single solutions
//   would
//                 be k. Scratch means without the speed-ups of Miller, Stone & Cox: k · rows solutions (`against_scratch`,
//                 computed).
//   ground_step   one instant of 25 people on a pitch, from 1 to 16 cameras: mht over gnn (`against_gnn`), in the same run.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include <benchmark/benchmark.h>

#include "marey/assign/gated_assignment.h"
#include "marey/assign/k_best_assignments.h"
#include "marey/simulate/random.h"
#include "marey/track/ground/ground_tracker.h"

namespace marey {
namespace {

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// A scuffle: every row has three columns in its gate.
std::vector<assign::GatedPair> scuffle(int count) {
  simulate::Random random(4);
  std::vector<assign::GatedPair> pairs;
  for (int row = 0; row < count; ++row) {
    for (int neighbour = -1; neighbour <= 1; ++neighbour) {
      const double gain = neighbour == 0 ? random.uniform(5, 9) : random.uniform(2, 7);
      pairs.push_back({row, (row + neighbour + count) % count, gain});
    }
  }
  return pairs;
}

void k_best(benchmark::State& state) {
  const int count = static_cast<int>(state.range(0));
  const int k = static_cast<int>(state.range(1));
  const auto pairs = scuffle(count);
  const assign::AssignmentProblem problem{count, count, pairs};
  assign::KBestAssigner assigner;
  assign::GatedAssigner one;
  double ours = 0;
  double single = 0;
  for (auto _ : state) {
    double begin = now_s();
    benchmark::DoNotOptimize(assigner.find({&problem, 1}, k));
    double end = now_s();
    ours += end - begin;
    state.SetIterationTime(end - begin);
    begin = now_s();
    benchmark::DoNotOptimize(one.assign(count, count, pairs));
    single += now_s() - begin;
  }
  state.counters["against_one"] = ours / single;
  state.counters["against_scratch"] = ours / (single * k * count);
}
BENCHMARK(k_best)->ArgsProduct({{5, 25, 100}, {1, 50}})->UseManualTime()->Unit(benchmark::kMicrosecond);

/// People who run about a pitch and meet, as each of some cameras sees them.
class Game {
 public:
  Game(int people, int cameras) : random_(1), locations_(people), velocities_(people), cameras_(cameras) {
    for (Vector<2>& location : locations_) location = {random_.uniform(0, 105), random_.uniform(0, 68)};
  }

  std::vector<GroundView> views() const {
    Matrix<3> ground_from_image;
    ground_from_image << 0.1, 0, -20, 0, -0.1, 88, 0, 0, 1;
    return std::vector<GroundView>(static_cast<std::size_t>(cameras_), GroundView(ground_from_image, cv::Size(1450, 1080)));
  }

  std::span<const track::ground::CameraObservations> next(Timestamp now) {
    for (std::size_t i = 0; i < locations_.size(); ++i) {
      velocities_[i] += Vector<2>(random_.gaussian(0, 0.4), random_.gaussian(0, 0.4)) - 0.02 * velocities_[i] -
                        0.001 * (locations_[i] - Vector<2>(52.5, 34));
      locations_[i] += velocities_[i] / 25;
    }
    detected_.assign(static_cast<std::size_t>(cameras_), {});
    appearances_.clear();
    for (int camera = 0; camera < cameras_; ++camera) {
      auto& detected = detected_[static_cast<std::size_t>(camera)];
      for (const Vector<2>& location : locations_) {
        if (random_.chance(0.1)) continue;
        Observation<2>& one = detected.emplace_back();
        one.value = location + Vector<2>(random_.gaussian(0, 0.2), random_.gaussian(0, 0.2));
        one.covariance = 0.04 * Matrix<2>::Identity();
        one.camera = CameraId{camera};
        one.score = 0.9;
      }
      appearances_.push_back({CameraId{camera}, now, detected});
    }
    return appearances_;
  }

 private:
  simulate::Random random_;
  std::vector<Vector<2>> locations_, velocities_;
  int cameras_;
  std::vector<std::vector<Observation<2>>> detected_;
  std::vector<track::ground::CameraObservations> appearances_;
};

void ground_step(benchmark::State& state) {
  Game game(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  const auto gnn =
      track::ground::make_ground_tracker({.associate = track::ground::GroundAssociation::gnn}, ground_views(game.views()));
  const auto mht =
      track::ground::make_ground_tracker({.associate = track::ground::GroundAssociation::mht}, ground_views(game.views()));
  int frame = 0;
  double of_gnn = 0;
  double of_mht = 0;
  const auto step = [&] {
    const Timestamp now = timestamp_from_seconds(frame++ / 25.0);
    const auto appearances = game.next(now);
    const double begin = now_s();
    benchmark::DoNotOptimize(gnn->step(now, appearances));
    const double middle = now_s();
    benchmark::DoNotOptimize(mht->step(now, appearances));
    const double end = now_s();
    of_gnn += middle - begin;
    of_mht += end - middle;
    return end - middle;
  };
  while (frame < 50) step();
  of_gnn = of_mht = 0;
  for (auto _ : state) state.SetIterationTime(step());
  state.counters["gnn_us"] = benchmark::Counter(1e6 * of_gnn, benchmark::Counter::kAvgIterations);
  state.counters["against_gnn"] = of_mht / of_gnn;
}
BENCHMARK(ground_step)
    ->ArgNames({"people", "cameras"})
    ->Args({25, 1})
    ->Args({25, 2})
    ->Args({25, 6})
    ->Args({25, 16})
    ->Args({100, 2})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->MinTime(0.3);

}  // namespace
}  // namespace marey
