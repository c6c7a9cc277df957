// Files of points, 50 markers: reading and writing one frame, beside writing and reading the same bytes plainly (the bound).
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "marey/format/motion/motion.h"
#include "marey/format/take/take_file.h"

namespace marey {
namespace {

constexpr int kMarkers = 50;
constexpr int kFrames = 2000;

std::string place(const char* name) {
  return (std::filesystem::temp_directory_path() / name).string();
}

TakeFrame frame_of(std::int64_t index) {
  TakeFrame frame;
  frame.index = index;
  frame.time = timestamp_from_seconds(static_cast<double>(index) / 120);
  for (int m = 1; m <= kMarkers; ++m) {
    TakePoint point;
    point.track = TrackId(m);
    point.position = {0.1 * m, 1e-3 * static_cast<double>(index), 1.0 / m};
    point.cameras = 0b1011;
    point.residual_m = 0.0004;
    frame.points.push_back(point);
  }
  return frame;
}

format::motion::MotionPlan plan() {
  format::motion::MotionPlan plan;
  plan.info.header.rate_hz = 120;
  for (int m = 1; m <= kMarkers; ++m) plan.info.tracks.push_back({TrackId(m), fmt::format("M{}", m)});
  plan.last_frame = kFrames - 1;
  plan.farthest_m = 5;
  plan.tells_measured = true;
  return plan;
}

void per_frame(benchmark::State& state, std::size_t bytes) {
  state.counters["frames/s"] = benchmark::Counter(static_cast<double>(state.iterations() * kFrames), benchmark::Counter::kIsRate);
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * bytes));
}

void write_all(const std::string& path, format::motion::MotionFormat format, const std::vector<TakeFrame>& frames) {
  const auto writer = format::motion::create_motion(path, format, plan());
  for (const TakeFrame& frame : frames) writer->write(frame);
  writer->finish();
}

std::vector<TakeFrame> all_frames() {
  std::vector<TakeFrame> frames;
  for (int i = 0; i < kFrames; ++i) frames.push_back(frame_of(i));
  return frames;
}

void write_format(benchmark::State& state, format::motion::MotionFormat format, const char* name) {
  const std::string path = place(name);
  const auto frames = all_frames();
  for (auto _ : state) write_all(path, format, frames);
  per_frame(state, std::filesystem::file_size(path));
  std::filesystem::remove(path);
}

void read_format(benchmark::State& state, format::motion::MotionFormat format, const char* name) {
  const std::string path = place(name);
  write_all(path, format, all_frames());
  for (auto _ : state) {
    const auto reader = format::motion::open_motion(path, format);
    while (const auto frame = reader->next()) benchmark::DoNotOptimize(frame->points.data());
  }
  per_frame(state, std::filesystem::file_size(path));
  std::filesystem::remove(path);
}

/// The bytes of a C3D file of this length, written and read with one call a frame and nothing else.
void write_plainly(benchmark::State& state) {
  const std::string path = place("bound.bin");
  const std::vector<float> row(4 * kMarkers, 1.0F);
  for (auto _ : state) {
    std::FILE* file = std::fopen(path.c_str(), "wb");
    for (int i = 0; i < kFrames; ++i) std::fwrite(row.data(), sizeof(float), row.size(), file);
    std::fclose(file);
  }
  per_frame(state, std::filesystem::file_size(path));
  std::filesystem::remove(path);
}

void read_plainly(benchmark::State& state) {
  const std::string path = place("bound.bin");
  std::vector<float> row(4 * kMarkers, 1.0F);
  std::FILE* out = std::fopen(path.c_str(), "wb");
  for (int i = 0; i < kFrames; ++i) std::fwrite(row.data(), sizeof(float), row.size(), out);
  std::fclose(out);
  for (auto _ : state) {
    std::FILE* file = std::fopen(path.c_str(), "rb");
    while (std::fread(row.data(), sizeof(float), row.size(), file) == row.size()) benchmark::DoNotOptimize(row.data());
    std::fclose(file);
  }
  per_frame(state, std::filesystem::file_size(path));
  std::filesystem::remove(path);
}

BENCHMARK(write_plainly)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(write_format, c3d, format::motion::MotionFormat::c3d, "bench.c3d")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(write_format, take, format::motion::MotionFormat::take, "bench.marey")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(write_format, trc, format::motion::MotionFormat::trc, "bench.trc")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(write_format, csv, format::motion::MotionFormat::csv, "bench.csv")->Unit(benchmark::kMillisecond);
BENCHMARK(read_plainly)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read_format, c3d, format::motion::MotionFormat::c3d, "bench.c3d")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read_format, take, format::motion::MotionFormat::take, "bench.marey")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read_format, trc, format::motion::MotionFormat::trc, "bench.trc")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read_format, csv, format::motion::MotionFormat::csv, "bench.csv")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace marey
