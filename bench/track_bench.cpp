// Tracker step with growing numbers of targets, gated assignment beside a dense one. Relevant figures: the time a target, which
// should barely grow with the number of targets.
#include <cmath>
#include <vector>

#include <benchmark/benchmark.h>

#include "marey/assign/gated_assignment.h"
#include "marey/assign/linear_assignment.h"
#include "marey/simulate/random.h"
#include "marey/track/roster/roster_tracker.h"
#include "marey/track/tracker.h"

namespace marey {
namespace {

constexpr double rate = 25;  // Hz

/// `count` people who walk about a plain, as dense as a busy street; one in ten is missed.
class Crowd {
 public:
  explicit Crowd(int count) : random_(1), side_(60 * std::sqrt(count)) {
    for (int i = 0; i < count; ++i) {
      locations_.push_back({random_.uniform(0, side_), random_.uniform(0, side_)});
      velocities_.push_back({random_.gaussian(0, 1.5), random_.gaussian(0, 0.5)});
    }
  }

  const std::vector<Observation<2>>& next() {
    detected_.clear();
    for (std::size_t i = 0; i < locations_.size(); ++i) {
      locations_[i] += velocities_[i];
      if (random_.chance(0.1)) continue;
      Observation<2> one;
      one.value = locations_[i] + Vector<2>(random_.gaussian(), random_.gaussian());
      one.box = Box::from_centre(one.value, 32, 80);
      one.score = 0.9;
      detected_.push_back(one);
    }
    return detected_;
  }

 private:
  simulate::Random random_;
  double side_;
  std::vector<Vector<2>> locations_, velocities_;
  std::vector<Observation<2>> detected_;
};

void tracker_step(benchmark::State& state) {
  const int count = static_cast<int>(state.range(0));
  Crowd crowd(count);
  const auto tracker = track::make_tracker({.stabilised_camera = true});
  int frame = 0;
  for (; frame < 10; ++frame) tracker->step(timestamp_from_seconds(frame / rate), crowd.next());
  for (auto _ : state) {
    state.PauseTiming();
    const auto& detected = crowd.next();
    state.ResumeTiming();
    benchmark::DoNotOptimize(tracker->step(timestamp_from_seconds(frame++ / rate), detected));
  }
  state.counters["a_target"] =
      benchmark::Counter(count, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(tracker_step)->RangeMultiplier(10)->Range(10, 10000)->Unit(benchmark::kMillisecond);

/// Markers that drift over a sheet with 60 px a side for each, one in fifty missed in a frame.
void marker_step(benchmark::State& state) {
  const int count = static_cast<int>(state.range(0));
  constexpr double kRate = 30;
  simulate::Random random(3);
  const double side = 60 * std::sqrt(static_cast<double>(count));
  std::vector<Vector<2>> locations, steps;
  for (int i = 0; i < count; ++i) {
    locations.emplace_back(random.uniform(0, side), random.uniform(0, side));
    steps.emplace_back(random.uniform(-2, 2), random.uniform(-2, 2));
  }
  std::vector<Observation<2>> detected;
  const auto inspect = [&] {
    detected.clear();
    for (int i = 0; i < count; ++i) {
      locations[i] += steps[i];
      if (random.chance(0.02)) continue;
      auto& point = detected.emplace_back();
      point.value = locations[i] + Vector<2>(random.gaussian(0, 0.05), random.gaussian(0, 0.05));
      point.covariance = 0.0025 * Matrix<2>::Identity();
      point.box = Box::from_centre(point.value, 8, 8);
    }
  };
  const auto tracker = track::roster::make_roster_tracker<2>({});
  int frame = 0;
  for (; frame < 5; ++frame) {
    inspect();
    tracker->step(timestamp_from_seconds(frame / kRate), detected);
  }
  for (auto _ : state) {
    state.PauseTiming();
    inspect();
    state.ResumeTiming();
    benchmark::DoNotOptimize(tracker->step(timestamp_from_seconds(frame++ / kRate), detected));
  }
}
BENCHMARK(marker_step)->Arg(1)->Arg(30)->Arg(1000)->Arg(10000)->Unit(benchmark::kMillisecond)->MinTime(0.2);

/// Every row with about three columns in its gate.
std::vector<assign::GatedPair> gated_pairs(int count) {
  simulate::Random random(2);
  std::vector<assign::GatedPair> pairs;
  for (int row = 0; row < count; ++row) {
    pairs.push_back({row, row, random.uniform(1, 10)});
    for (int neighbour = 1; neighbour <= 2; ++neighbour) {
      if (random.chance(0.4)) pairs.push_back({row, (row + neighbour) % count, random.uniform(0.1, 8)});
    }
  }
  return pairs;
}

void assign_gated(benchmark::State& state) {
  const int count = static_cast<int>(state.range(0));
  const auto pairs = gated_pairs(count);
  assign::GatedAssigner assigner;
  for (auto _ : state) benchmark::DoNotOptimize(assigner.assign(count, count, pairs));
}
BENCHMARK(assign_gated)->RangeMultiplier(10)->Range(10, 10000)->Unit(benchmark::kMicrosecond);

void assign_dense(benchmark::State& state) {
  const int count = static_cast<int>(state.range(0));
  std::vector<double> costs(static_cast<std::size_t>(count) * count, 0);
  for (const assign::GatedPair& pair : gated_pairs(count))
    costs[static_cast<std::size_t>(pair.row) * count + pair.column] = -pair.gain;
  assign::LinearAssigner assigner;
  for (auto _ : state) benchmark::DoNotOptimize(assigner.assign(count, count, costs));
}
BENCHMARK(assign_dense)->RangeMultiplier(10)->Range(10, 1000)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace marey
