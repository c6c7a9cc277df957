// Rigid bodies among points without names, an instant at a time, on one core: fifty bodies of five markers followed in 300 points,
// ten of them found from nothing in 100 points, and the poses found of bodies that are not there. Counters: the time that 99 of 100
// instants keep (CPU time), the share of instants with a pose, and the share of searches that find an absent body.
#include <algorithm>
#include <cstdint>
#include <ctime>
#include <vector>

#include <benchmark/benchmark.h>

#include "marey/solve/bodies/body_tracker.h"
#include "marey/solve/bodies/moving_bodies_test.h"

namespace {

using namespace marey;
using namespace marey::solve::bodies;

constexpr double kRateHz = 100;
constexpr double kNoiseM = 0.0002;

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Bodies of five markers on paths through a room of 6 m, and single points on paths of their own.
struct Room {
  std::vector<Body> bodies;
  std::vector<moving::Path> paths, others;

  Room(int count, int points, moving::Random& random) {
    for (int b = 0; b < count; ++b) {
      bodies.push_back(moving::body_of(b + 1, moving::scattered(random, 5, 0.12, 0.04)));
      paths.emplace_back(random, random.in_box(3));
    }
    for (int p = 5 * count; p < points; ++p) others.emplace_back(random, random.in_box(3));
  }

  std::vector<BodyTrackPoint> detected(double time, moving::Random& random) const {
    std::vector<BodyTrackPoint> points;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      for (const BodyMarker& marker : bodies[b].markers)
        points.push_back({paths[b].at(time) * marker.position + random.gaussian(kNoiseM), {}});
    }
    for (const moving::Path& path : others) points.push_back({path.at(time).translation + random.gaussian(kNoiseM), {}});
    return points;
  }
};

void report(benchmark::State& state, std::vector<double>& times) {
  std::sort(times.begin(), times.end());
  if (times.empty()) return;
  state.counters["median_ms"] = 1e3 * times[times.size() / 2];
  state.counters["p99_ms"] = 1e3 * times[times.size() * 99 / 100];
}

void track_fifty(benchmark::State& state) {
  moving::Random random(1);
  const Room room(50, 300, random);
  BodyTracker tracker(room.bodies);
  std::vector<double> times;
  std::int64_t reported = 0, instants = 0;
  for (auto _ : state) {
    const double time = static_cast<double>(instants) / kRateHz;
    state.PauseTiming();
    const auto points = room.detected(time, random);
    state.ResumeTiming();
    const double begin = cpu_seconds();
    const auto poses = tracker.step(timestamp_from_seconds(time), points);
    if (instants > 20) times.push_back(cpu_seconds() - begin);  // all are found by then
    reported += std::count_if(poses.begin(), poses.end(), [](const BodyPose& pose) { return pose.tracked; });
    ++instants;
  }
  report(state, times);
  state.counters["tracked"] = static_cast<double>(reported) / static_cast<double>(50 * instants);
}
BENCHMARK(track_fifty)->Unit(benchmark::kMillisecond)->Iterations(1000);

/// From nothing: each time a follower that knows no body.
void initialise_ten(benchmark::State& state) {
  moving::Random random(2);
  const Room room(10, 100, random);
  std::vector<double> times;
  std::int64_t reported = 0, instants = 0;
  for (auto _ : state) {
    state.PauseTiming();
    const auto points = room.detected(static_cast<double>(instants++) / kRateHz, random);
    BodyTracker tracker(room.bodies);
    state.ResumeTiming();
    const double begin = cpu_seconds();
    reported += std::ssize(tracker.step(timestamp_from_seconds(0), points));
    times.push_back(cpu_seconds() - begin);
  }
  report(state, times);
  state.counters["found"] = static_cast<double>(reported) / static_cast<double>(10 * instants);
}
BENCHMARK(initialise_ten)->Unit(benchmark::kMillisecond)->Iterations(500);

/// This many points, and nine bodies of three, four and five markers that are not among them.
void search_absent(benchmark::State& state) {
  moving::Random random(3);
  const Room room(0, static_cast<int>(state.range(0)), random);
  std::vector<Body> absent;
  for (int b = 0; b < 9; ++b) absent.push_back(moving::body_of(b + 1, moving::scattered(random, 3 + b / 3, 0.12, 0.04)));
  BodyTracker tracker(absent);
  std::vector<double> times;
  std::int64_t reported = 0, instants = 0;
  for (auto _ : state) {
    const double time = static_cast<double>(instants++) / kRateHz;
    state.PauseTiming();
    const auto points = room.detected(time, random);
    state.ResumeTiming();
    const double begin = cpu_seconds();
    const auto poses = tracker.step(timestamp_from_seconds(time), points);
    times.push_back(cpu_seconds() - begin);
    reported += std::count_if(poses.begin(), poses.end(), [](const BodyPose& pose) { return pose.tracked; });
  }
  report(state, times);
  state.counters["found_absent"] = static_cast<double>(reported) / static_cast<double>(9 * instants);
}
BENCHMARK(search_absent)->Arg(60)->Arg(100)->Arg(300)->Unit(benchmark::kMillisecond)->Iterations(1000);

}  // namespace
