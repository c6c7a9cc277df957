// The second pass over the ground: minutes of 25 people at 25 frames a second, lost every half minute or so. Relevant figures: the
// time a person and instant, which should not grow with the length; beside it what a plain forward Kalman filter takes over the
// same samples
// (`against_filter`: that over ours), which nothing that smooths can undercut.
#include <cmath>
#include <vector>

#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include "marey/filter/kalman.h"
#include "marey/simulate/random.h"
#include "marey/track/ground/offline/ground_recorder.h"

namespace marey {
namespace {

constexpr double rate = 25;  // Hz
constexpr int people = 25;

/// People who run about a pitch; each is lost now and then for some seconds and found again under another id.
class Game {
 public:
  Game() : locations_(people, Vector<2>(50, 30)), velocities_(people, Vector<2>::Zero()), ids_(people), hidden_(people, 0) {
    for (int& id : ids_) id = next_id_++;
  }

  void record(int instants, track::ground::offline::GroundRecorder& recorder) {
    for (int k = 0; k < instants; ++k) {
      const Timestamp now = timestamp_from_seconds(k / rate);
      tracks_.clear();
      detected_.clear();
      claims_.clear();
      for (int i = 0; i < people; ++i) move(i);
      std::sort(tracks_.begin(), tracks_.end(), [](const Track<2>& a, const Track<2>& b) { return a.id < b.id; });
      const track::ground::CameraObservations inspect{CameraId{0}, now, detected_};
      recorder.add(k, now, tracks_, {&inspect, 1}, claims_);
    }
  }

 private:
  void move(int i) {
    velocities_[i] = 0.99 * velocities_[i] + Vector<2>(random_.gaussian(0, 0.3), random_.gaussian(0, 0.3));
    locations_[i] += velocities_[i] / rate - 0.0005 * (locations_[i] - Vector<2>(50, 30));
    if (hidden_[i] > 0) {
      if (--hidden_[i] == 0) ids_[i] = next_id_++;
      return;
    }
    if (random_.chance(1 / (30 * rate))) hidden_[i] = random_.integer(10, 150);
    Track<2> track;
    track.id = TrackId{ids_[i]};
    track.position = locations_[i];
    Observation<2> one;
    one.value = locations_[i] + Vector<2>(random_.gaussian(0, 0.2), random_.gaussian(0, 0.2));
    one.covariance = 0.04 * Matrix<2>::Identity();
    one.appearance = i % 2 == 0 ? Appearance{85, 0, 0, 6} : Appearance{35, 10, -40, 6};
    claims_.push_back({track.id, 0, static_cast<int>(detected_.size())});
    detected_.push_back(one);
    tracks_.push_back(track);
  }

  simulate::Random random_{1};
  std::vector<Vector<2>> locations_, velocities_;
  std::vector<int> ids_;
  std::vector<int> hidden_;
  int next_id_ = 1;
  std::vector<Track<2>> tracks_;
  std::vector<Observation<2>> detected_;
  std::vector<track::ground::ObservationMatch> claims_;
};

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double filter_seconds(std::int64_t samples) {
  filter::Kalman<2> filter({.acceleration_noise = 2.5, .initial_speed = 3}, Vector<2>::Zero(), Matrix<2>::Identity());
  const Matrix<2> R = 0.04 * Matrix<2>::Identity();
  const double begin = now_s();
  for (std::int64_t k = 0; k < samples; ++k) {
    filter.predict(1 / rate);
    filter.correct(Vector<2>(0.01 * static_cast<double>(k % 100), 1), R);
  }
  benchmark::DoNotOptimize(filter.position());
  return now_s() - begin;
}

void second_pass(benchmark::State& state) {
  const int instants = static_cast<int>(static_cast<double>(state.range(0)) * 60 * rate);
  double minimum = 1e9;
  std::size_t rows = 0;
  for (auto _ : state) {
    track::ground::offline::GroundRecorder recorder;
    Game().record(instants, recorder);
    const double begin = now_s();
    const track::ground::offline::GroundRecorder::Joined joined = std::move(recorder).join();
    const double took = now_s() - begin;
    minimum = std::min(minimum, took);
    rows = static_cast<std::size_t>(joined.recording.samples());
    state.counters["people"] = static_cast<double>(joined.recording.tracks().size());
    state.SetIterationTime(took);
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  state.counters["peak_MB"] = static_cast<double>(usage.ru_maxrss) / 1024;
  state.counters["ns_a_row"] = minimum / static_cast<double>(rows) * 1e9;
  state.counters["against_filter"] = filter_seconds(static_cast<std::int64_t>(rows)) / minimum;
}
BENCHMARK(second_pass)->Arg(1)->Arg(10)->Arg(90)->Unit(benchmark::kMillisecond)->UseManualTime()->Iterations(1);

}  // namespace
}  // namespace marey
