// Names for markers while cameras see them, on one core, CPU time: how long names are searched for from nothing in the first half
// second of a simulated walk (a task of its own does that), and how long a frame takes from then on: points hidden and back, their
// tracks broken. The set was learned from another segment of the walk. Counters: the share of markers found; what 99 of 100 frames
// keep; the share of points with the right name.
#include <algorithm>
#include <cstdint>
#include <ctime>
#include <map>
#include <vector>

#include <benchmark/benchmark.h>

#include "marey/simulate/random.h"
#include "marey/simulate/room/room.h"
#include "marey/solve/labels/find_names.h"
#include "marey/solve/labels/learn_markers.h"

namespace {

using namespace marey;

constexpr double kBenchRate = 100;

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Walker {
  simulate::room::RoomScene scene;
  LearnedMarkers learned;

  explicit Walker(int markers) : scene(options(markers)) {
    Recording taught = recording(15, 400);
    for (std::size_t m = 0; m < scene.labels().size(); ++m)
      taught.set_name({TrackId{static_cast<int>(m) + 1}, scene.labels()[m], {}});
    const std::vector<Recording> all{std::move(taught)};
    learned = solve::labels::learn_markers(all, {});
  }

  static simulate::room::RoomOptions options(int markers) {
    simulate::room::RoomOptions room;
    room.markers = markers;
    room.rate_hz = kBenchRate;
    room.frames = 2000;
    return room;
  }

  /// Half a millimetre of noise along each axis.
  Recording recording(double from_s, int frames) const {
    simulate::Random noise(3);
    Recording recording;
    recording.header.rate_hz = kBenchRate;
    for (int i = 0; i < frames; ++i) {
      Instant instant;
      instant.index = i;
      instant.time = timestamp_from_seconds(i / kBenchRate);
      const auto points = scene.points(from_s + i / kBenchRate);
      for (std::size_t m = 0; m < points.size(); ++m) {
        Sample& sample = instant.samples.emplace_back();
        sample.track = TrackId{static_cast<int>(m) + 1};
        sample.position = points[m] + Vector<3>(noise.gaussian(0, 5e-4), noise.gaussian(0, 5e-4), noise.gaussian(0, 5e-4));
      }
      recording.add(instant);
    }
    return recording;
  }
};

solve::labels::LabelOptions live_options() {
  solve::labels::LabelOptions options;
  options.initialises = 2;
  options.initialise.answers = 250;
  return options;
}

void find_names(benchmark::State& state) {
  const Walker walker(static_cast<int>(state.range(0)));
  const Recording recent = walker.recording(2, 50);
  std::size_t found = 0;
  std::vector<double> times;
  for (auto _ : state) {
    const double begin = thread_seconds();
    found = solve::labels::find_names(recent, walker.learned, live_options(), {}).name_of.size();
    times.push_back(thread_seconds() - begin);
  }
  std::sort(times.begin(), times.end());
  state.counters["cpu_s"] = times[times.size() / 2];
  state.counters["found"] = static_cast<double>(found) / static_cast<double>(walker.learned.size());
}
BENCHMARK(find_names)->ArgName("markers")->Arg(40)->Arg(60)->Unit(benchmark::kMillisecond);

void track_names(benchmark::State& state) {
  const Walker walker(static_cast<int>(state.range(0)));
  const auto count = static_cast<std::size_t>(state.range(0));
  std::vector<double> times;
  std::int64_t right = 0, all = 0;
  for (auto _ : state) {
    auto found = solve::labels::find_names(walker.recording(2, 50), walker.learned, live_options(), {});
    found.tracker->take(found.name_of);
    simulate::Random random(9);
    std::vector<int> track(count), hidden(count, 0);
    for (std::size_t m = 0; m < count; ++m) track[m] = static_cast<int>(m) + 1;
    int next = 1000;
    std::vector<solve::labels::TrackedPoint> points;
    std::vector<std::size_t> marker;
    for (int i = 50; i < 1000; ++i) {
      const auto locations = walker.scene.points(2 + i / kBenchRate);
      points.clear(), marker.clear();
      for (std::size_t m = 0; m < count; ++m) {
        if (hidden[m] == 0 && random.chance(0.005)) hidden[m] = random.integer(1, 19), track[m] = next++;
        if (hidden[m] > 0 && hidden[m]-- > 0) continue;
        points.push_back({TrackId{track[m]}, locations[m]});
        marker.push_back(m);
      }
      const double begin = thread_seconds();
      const auto names = found.tracker->step(timestamp_from_seconds(i / kBenchRate), points);
      times.push_back(thread_seconds() - begin);
      for (std::size_t p = 0; p < points.size(); ++p)
        right += names[p] >= 0 && walker.learned.labels[static_cast<std::size_t>(names[p])] == walker.scene.labels()[marker[p]];
      all += std::ssize(points);
    }
  }
  std::sort(times.begin(), times.end());
  state.counters["median_ms"] = 1000 * times[times.size() / 2];
  state.counters["p99_ms"] = 1000 * times[times.size() * 99 / 100];
  state.counters["right"] = static_cast<double>(right) / static_cast<double>(all);
}
BENCHMARK(track_names)->ArgName("markers")->Arg(40)->Arg(60)->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
