// People followed on the ground: one instant of 16 cameras and 25 people, boxes in, places included; and the tracker alone with
// growing numbers of targets. Relevant figures: milliseconds an instant, and `ratio`, by how much it takes longer than a Kalman
// filter's predictions and corrections of the same observations when it is known whose each is.
#include <chrono>
#include <cmath>
#include <vector>

#include <benchmark/benchmark.h>

#include "marey/filter/kalman.h"
#include "marey/reconstruct/place_people.h"
#include "marey/simulate/match/match_cameras.h"
#include "marey/simulate/match/match_view.h"
#include "marey/simulate/random.h"
#include "marey/track/ground/ground_tracker.h"

namespace marey {
namespace {

constexpr double rate = 25;  // Hz

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

track::ground::GroundAssociation association(std::int64_t index) {
  constexpr track::ground::GroundAssociation all[] = {track::ground::GroundAssociation::gnn, track::ground::GroundAssociation::jpda,
                                                      track::ground::GroundAssociation::mht};
  return all[index];
}

/// Detections of every camera at one instant.
using Boxes = std::vector<std::vector<Detection>>;

/// A simulated match seen by `cameras`, 10 s of it, boxes with noise, misses and false ones.
struct Match {
  explicit Match(int count) {
    simulate::match::MatchCamerasOptions options;
    options.cameras = count;
    for (const RigCamera& camera : simulate::match::match_cameras(options, 1).cameras) cameras.push_back(camera.camera().value());
    simulate::match::MatchMotion motion(1);
    const auto figures = simulate::match::match_figures(1);
    simulate::Random random(1);
    for (int frame = 0; frame < 250; ++frame) {
      motion.advance(frame / rate);
      std::array<simulate::people::Stance, simulate::match::kMatchPeople> stances;
      for (std::size_t i = 0; i < stances.size(); ++i)
        stances[i] = simulate::match::match_stance(motion.people()[i], Matrix<3>::Identity());
      auto& boxes = instants.emplace_back();
      for (const Camera& camera : cameras) {
        auto& detected = boxes.emplace_back();
        for (const LabelledBox& one :
             simulate::match::detect_match(simulate::match::people_in_view(GroundView(camera), figures, stances),
                                           GroundView(camera), Matrix<3>::Identity(), {}, frame, {}, random)) {
          detected.emplace_back();
          detected.back().box = one.box;
          detected.back().score = one.score;
        }
      }
    }
  }

  std::vector<Camera> cameras;
  std::vector<Boxes> instants;
};

/// 25 people, 16 cameras, boxes in: one instant, fused. The goal is 1 ms.
void instant_of_a_match(benchmark::State& state) {
  const Match match(16);
  std::vector<GroundView> views(match.cameras.begin(), match.cameras.end());
  double spent = 0, bound = 0;
  std::size_t observations = 0;
  for (auto _ : state) {
    const auto tracker = track::ground::make_ground_tracker({.associate = association(state.range(0))}, ground_views(views));
    std::vector<filter::Kalman<2>> known(simulate::match::kMatchPeople,
                                         filter::Kalman<2>({2, 3, 3}, Vector<2>::Zero(), Matrix<2>::Identity()));
    double here = 0;
    for (std::size_t frame = 0; frame < match.instants.size(); ++frame) {
      const Timestamp now = timestamp_from_seconds(static_cast<double>(frame) / rate);
      auto begin = std::chrono::steady_clock::now();
      std::vector<reconstruct::LocatedPeople> located;
      std::vector<track::ground::CameraObservations> appearances;
      for (int c = 0; c < static_cast<int>(views.size()); ++c)
        located.push_back(reconstruct::localise_people(match.instants[frame][c], views[c], CameraId{c}));
      for (int c = 0; c < static_cast<int>(views.size()); ++c) appearances.push_back({CameraId{c}, now, located[c].detected});
      benchmark::DoNotOptimize(tracker->step(now, appearances));
      here += seconds_since(begin);
      begin = std::chrono::steady_clock::now();
      for (filter::Kalman<2>& one : known) one.predict(1 / rate);
      for (const reconstruct::LocatedPeople& inspect : located) {
        for (std::size_t i = 0; i < inspect.detected.size(); ++i)
          known[i % known.size()].correct(inspect.detected[i].value, *inspect.detected[i].covariance);
        observations += inspect.detected.size();
      }
      benchmark::DoNotOptimize(known.data());
      bound += seconds_since(begin);
    }
    state.SetIterationTime(here / static_cast<double>(match.instants.size()));
    spent += here;
  }
  state.counters["ratio"] = spent / bound;
  state.counters["observations"] =
      static_cast<double>(observations) / static_cast<double>(match.instants.size()) / static_cast<double>(state.iterations());
}
BENCHMARK(instant_of_a_match)
    ->ArgName("gnn_jpda_mht")
    ->DenseRange(0, 2)
    ->Iterations(3)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

/// People about 17 m apart on a plain, as on a pitch, seen by one camera from above; one in ten is missed.
void tracker_alone(benchmark::State& state) {
  const auto count = static_cast<int>(state.range(0));
  const double side = 17 * std::sqrt(count);
  Matrix<3> ground_from_image;
  ground_from_image << 0.1, 0, 0, 0, -0.1, side, 0, 0, 1;
  const GroundView view(ground_from_image, cv::Size(static_cast<int>(10 * side), static_cast<int>(10 * side)));
  const auto tracker = track::ground::make_ground_tracker({.associate = association(state.range(1))}, ground_views({view}));
  simulate::Random random(1);
  std::vector<Vector<2>> locations, velocities;
  std::vector<filter::Kalman<2>> known;
  for (int i = 0; i < count; ++i) {
    locations.emplace_back(random.uniform(0, side), random.uniform(0, side));
    velocities.emplace_back(random.gaussian(0, 2), random.gaussian(0, 2));
    known.emplace_back(filter::KalmanOptions{2, 3, 3}, locations.back(), Matrix<2>::Identity());
  }
  double spent = 0, bound = 0;
  int frame = 0;
  std::vector<Observation<2>> detected;
  for (auto _ : state) {
    detected.clear();
    for (int i = 0; i < count; ++i) {
      locations[i] += velocities[i] / rate;
      for (int axis = 0; axis < 2; ++axis) {
        if (locations[i][axis] < 0 || locations[i][axis] > side) velocities[i][axis] *= -1;
      }
      if (random.chance(0.1)) continue;
      auto& one = detected.emplace_back();
      one.value = locations[i] + Vector<2>(random.gaussian(0, 0.2), random.gaussian(0, 0.2));
      one.covariance = 0.04 * Matrix<2>::Identity();
      one.score = 0.9;
      one.box = Box{10 * one.value.x() - 3, 10 * (side - one.value.y()) - 18, 6, 18};
    }
    const Timestamp now = timestamp_from_seconds(frame++ / rate);
    const track::ground::CameraObservations inspect{CameraId{0}, now, detected};
    auto begin = std::chrono::steady_clock::now();
    benchmark::DoNotOptimize(tracker->step(now, {&inspect, 1}));
    const double here = seconds_since(begin);
    state.SetIterationTime(here);
    spent += here;
    begin = std::chrono::steady_clock::now();
    for (filter::Kalman<2>& one : known) one.predict(1 / rate);
    for (std::size_t i = 0; i < detected.size(); ++i) known[i].correct(detected[i].value, *detected[i].covariance);
    benchmark::DoNotOptimize(known.data());
    bound += seconds_since(begin);
  }
  state.counters["ratio"] = spent / bound;
}
BENCHMARK(tracker_alone)
    ->ArgNames({"people", "gnn_jpda_mht"})
    ->ArgsProduct({{25, 100, 1000}, {0, 1, 2}})
    ->UseManualTime()
    ->MinTime(0.2)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace marey
