// What judging tracks costs: reading MOT text, a line; evaluating, a person in a frame, with the people of a street and of a crowd.
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "marey/evaluate/evaluation.h"
#include "marey/format/tracks/mot.h"

namespace {

using marey::LabelledBox;

struct Scene {
  std::vector<LabelledBox> truth, tracks;
};

/// People who walk about at random in a view that holds them loosely; tracks that jitter and now and then swap names.
Scene walkers(int people, int frames) {
  std::mt19937 random(7);
  const double side = 150 * std::sqrt(static_cast<double>(people));
  std::uniform_real_distribution<double> anywhere(0, side);
  std::normal_distribution<double> noise;
  std::vector<std::pair<double, double>> locations(people);
  for (auto& [x, y] : locations) x = anywhere(random), y = anywhere(random);
  std::vector<int> names(people);
  for (int i = 0; i < people; ++i) names[i] = i + 1;
  Scene scene;
  for (int frame = 0; frame < frames; ++frame) {
    if (frame % 20 == 0) std::swap(names[random() % people], names[random() % people]);
    for (int i = 0; i < people; ++i) {
      auto& [x, y] = locations[i];
      x = std::clamp(x + 3 * noise(random), 0.0, side);
      y = std::clamp(y + 3 * noise(random), 0.0, side);
      scene.truth.push_back({frame, i + 1, {x, y, 50, 120}, 1});
      scene.tracks.push_back({frame, names[i], {x + 3 * noise(random), y + 3 * noise(random), 50, 120}, 1});
    }
  }
  return scene;
}

void read_mot_text(benchmark::State& state) {
  std::string text;
  const Scene scene = walkers(22, 2000);
  for (const LabelledBox& box : scene.tracks) marey::format::tracks::append_mot(text, box);
  for (auto _ : state)
    benchmark::DoNotOptimize(marey::format::tracks::parse_mot(text, "tracks", marey::format::tracks::MotKind::tracks));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(scene.tracks.size()));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
}
BENCHMARK(read_mot_text)->Unit(benchmark::kMillisecond);

void evaluate_people(benchmark::State& state) {
  const int people = static_cast<int>(state.range(0));
  const Scene scene = walkers(people, 20'000 / people);
  for (auto _ : state) benchmark::DoNotOptimize(marey::evaluate::evaluate(scene.truth, scene.tracks));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(scene.truth.size()));
}
BENCHMARK(evaluate_people)->ArgName("people")->Arg(5)->Arg(22)->Arg(100)->Arg(500)->Unit(benchmark::kMillisecond);

}  // namespace
