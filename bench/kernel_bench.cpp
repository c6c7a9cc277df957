// The inner loops that are compiled for several levels of the processor, each by itself, on what lies in the cache: rows of 1,920
// pixels for the background model; a band of 64 rows of 1,280 pixels, and 160 pixels round a marker.
#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include <benchmark/benchmark.h>

#include "marey/detect/background/background_kernels.h"
#include "marey/detect/markers/marker_kernel.h"

namespace {

using namespace marey::detect;

constexpr int kWidth = 1920;

template <typename Value>
std::vector<Value> random_values(std::size_t count, unsigned minimum, unsigned maximum, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<unsigned> level(minimum, maximum);
  std::vector<Value> values(count);
  for (Value& value : values) value = static_cast<Value>(level(random));
  return values;
}

std::vector<std::uint8_t> bytes(unsigned minimum = 0, unsigned maximum = 255, unsigned seed = 1) {
  return random_values<std::uint8_t>(kWidth + 2, minimum, maximum, seed);
}

void classify(benchmark::State& state) {
  const auto pixels = bytes(), low = bytes(60, 120), high = bytes(120, 180);
  std::vector<std::uint8_t> mark(kWidth);
  const auto& kernels = background::background_kernels();
  for (auto _ : state) {
    kernels.classify(pixels.data(), low.data(), high.data(), kWidth, mark.data());
    benchmark::ClobberMemory();
  }
}

void classify_chroma(benchmark::State& state) {
  const auto pixels = bytes(), low = bytes(60, 120), high = bytes(120, 180);
  const std::uint8_t* const planes[3][2] = {
      {pixels.data(), pixels.data() + 900}, {low.data(), low.data() + 900}, {high.data(), high.data() + 900}};
  std::vector<std::uint8_t> mark(kWidth);
  const auto& kernels = background::background_kernels();
  for (auto _ : state) {
    kernels.classify_chroma(planes[0], planes[1], planes[2], kWidth / 2, mark.data());
    benchmark::ClobberMemory();
  }
}

void unite(benchmark::State& state) {
  const auto source = bytes();
  std::vector<std::uint8_t> target(kWidth);
  const auto& kernels = background::background_kernels();
  for (auto _ : state) {
    kernels.unite(source.data(), kWidth, target.data());
    benchmark::ClobberMemory();
  }
}

void vote(benchmark::State& state) {
  const auto marks = bytes(0, 1);
  const std::uint8_t* const rows[3] = {marks.data() + 1, marks.data() + 1, marks.data() + 1};
  std::vector<std::uint8_t> votes(kWidth);
  const auto& kernels = background::background_kernels();
  for (auto _ : state) {
    kernels.vote(rows, 4, kWidth, votes.data());
    benchmark::ClobberMemory();
  }
}

void learn(benchmark::State& state) {
  const auto pixels = bytes(), frozen = bytes(0, 1, 2);
  auto mean = random_values<std::int16_t>(kWidth, 0, 32640, 3);
  auto spread = bytes();
  const auto& kernels = background::background_kernels();
  for (auto _ : state) {
    kernels.learn(pixels.data(), frozen.data(), kWidth, 3, mean.data(), spread.data());
    benchmark::ClobberMemory();
  }
}

void band(benchmark::State& state) {
  const auto mean = random_values<std::int16_t>(kWidth, 0, 32640, 3);
  const std::int16_t* const rows[3] = {mean.data(), mean.data(), mean.data()};
  const auto spread = bytes();
  std::vector<std::uint8_t> low(kWidth), high(kWidth);
  const auto& kernels = background::background_kernels();
  for (auto _ : state) {
    kernels.band(rows, spread.data(), kWidth, 56, 8, low.data(), high.data());
    benchmark::ClobberMemory();
  }
}

void sort(benchmark::State& state) {
  auto rows = random_values<std::uint8_t>(16 * kWidth, 0, 255, 1);
  const auto& kernels = background::background_kernels();
  for (auto _ : state) {
    kernels.sort(rows.data(), 4, kWidth, kWidth);
    benchmark::ClobberMemory();
  }
}

void shortest_half(benchmark::State& state) {
  auto rows = random_values<std::uint8_t>(16 * kWidth, 0, 255, 1);
  background::background_kernels().sort(rows.data(), 4, kWidth, kWidth);
  std::vector<std::uint8_t> middle(kWidth), spread(kWidth);
  const auto& kernels = background::background_kernels();
  for (auto _ : state) {
    kernels.shortest_half(rows.data(), 16, kWidth, kWidth, middle.data(), spread.data());
    benchmark::ClobberMemory();
  }
}

/// Noise below the threshold with a few bright pixels.
template <typename Pixel>
void scan(benchmark::State& state) {
  constexpr int width = 1280, rows = 64;
  auto pixels = random_values<Pixel>(static_cast<std::size_t>(width) * rows, 0, 40, 1);
  for (std::size_t i = 777; i < pixels.size(); i += 3111) pixels[i] = 200;
  const std::vector<std::uint16_t> thresholds(width / 64, 60);
  std::vector<markers::MarkerHit> hits(static_cast<std::size_t>(width / 64) * rows);
  const markers::MarkerBand band{pixels.data(), width * sizeof(Pixel), rows, width, thresholds.data(), false};
  const auto& kernels = markers::marker_kernels();
  for (auto _ : state) benchmark::DoNotOptimize((sizeof(Pixel) == 1 ? kernels.scan_8 : kernels.scan_16)(band, hits.data()));
}

/// Pixels of a window 13 wide.
struct Window {
  std::vector<float> x, y, value, weight;
  Window() {
    for (int i = 0; i < 160; ++i) {
      x.push_back(static_cast<float>(i % 13 - 6));
      y.push_back(static_cast<float>(i / 13 - 6));
      value.push_back(0.5f);
      weight.push_back(1.0f);
    }
  }
  markers::MarkerSamples samples() const { return {x.data(), y.data(), value.data(), weight.data(), 160}; }
};

void linearise_disc(benchmark::State& state) {
  const Window window;
  const std::array<float, markers::kDiscParameters> at{0.2f, -0.1f, 3.0f, 0.7f, 1.0f, 0.05f};
  const auto& kernels = markers::marker_kernels();
  for (auto _ : state) benchmark::DoNotOptimize(kernels.linearise_disc(window.samples(), at.data()));
}

void linearise_discs(benchmark::State& state) {
  const Window window;
  const std::array<float, markers::kMaxParameters> parameters{1.0f, 0.05f, 0.7f, 0.2f, -0.1f, 3.0f,  4.0f, 1.0f,
                                                              2.0f, -3.0f, 2.0f, 2.5f, 1.0f,  -4.0f, 2.0f};
  const markers::DiscsAt at{parameters.data(), static_cast<int>(state.range(0)), state.range(1) != 0, false, 0};
  markers::DiscsSums sums;
  const auto& kernels = markers::marker_kernels();
  for (auto _ : state) {
    kernels.linearise_discs(window.samples(), at, sums);
    benchmark::ClobberMemory();
  }
}

BENCHMARK(classify);
BENCHMARK(classify_chroma);
BENCHMARK(unite);
BENCHMARK(vote);
BENCHMARK(learn);
BENCHMARK(band);
BENCHMARK(sort);
BENCHMARK(shortest_half);
BENCHMARK(scan<std::uint8_t>);
BENCHMARK(scan<std::uint16_t>);
BENCHMARK(linearise_disc);
BENCHMARK(linearise_discs)->Args({1, 0})->Args({1, 1})->Args({2, 0})->Args({2, 1})->Args({3, 0})->Args({4, 0});

}  // namespace
