// Files of points, 50 markers: reading and writing one frame, beside writing and reading the same bytes plainly (the bound).
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "marey/format/recording_file.h"
#include "marey/format/register.h"
#include "marey/format/take/take_file.h"

namespace marey {
namespace {

constexpr int kMarkers = 50;
constexpr int kFrames = 2000;

std::string location(const char* name) {
  return (std::filesystem::temp_directory_path() / name).string();
}

Instant instant_of(std::int64_t index, int cameras = 0) {
  Instant instant;
  instant.index = index;
  instant.time = timestamp_from_seconds(static_cast<double>(index) / 120);
  for (int m = 1; m <= kMarkers; ++m) {
    Sample& sample = instant.samples.emplace_back();
    sample.track = TrackId(m);
    sample.position = {0.1 * m, 1e-3 * static_cast<double>(index), 1.0 / m};
    sample.cameras = 0b1011;
    sample.residual_m = 0.0004;
    if (cameras > 0) sample.covariance = 1e-6 * Matrix<3>::Identity();
  }
  for (int c = 0; c < cameras; ++c) {
    for (int m = 1; m <= kMarkers; ++m) {
      const Vector<2> pixel(10.3 * m + 1e-3 * static_cast<double>(index), 500.7 - 7.1 * c);
      instant.detected.push_back({CameraId(c), pixel, 0.1, 12.5, TrackId(m)});
    }
  }
  return instant;
}

RecordingHeader header() {
  RecordingHeader header;
  header.rate_hz = 120;
  return header;
}

format::WritePlan plan() {
  format::WritePlan plan;
  plan.info.header = header();
  for (int m = 1; m <= kMarkers; ++m) plan.info.tracks.push_back({TrackId(m), fmt::format("M{}", m), {}});
  plan.last_frame = kFrames - 1;
  plan.farthest_m = 5;
  plan.reports_measured = true;
  return plan;
}

void per_frame(benchmark::State& state, std::size_t bytes) {
  state.counters["frames/s"] = benchmark::Counter(static_cast<double>(state.iterations() * kFrames), benchmark::Counter::kIsRate);
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * bytes));
}

void write_all(Sink& sink, const std::vector<Instant>& instants) {
  sink.begin(header());
  for (const Instant& instant : instants) sink.write(instant);
  sink.finish();
}

void write_all(const std::string& path, const char* format, const std::vector<Instant>& instants) {
  write_all(*format::create_recording(path, *format::format_named(format, format::Content::space), plan()), instants);
}

std::vector<Instant> all_instants(int cameras = 0) {
  std::vector<Instant> instants;
  for (int i = 0; i < kFrames; ++i) instants.push_back(instant_of(i, cameras));
  return instants;
}

void write_format(benchmark::State& state, const char* format, const char* name) {
  const std::string path = location(name);
  const auto instants = all_instants();
  for (auto _ : state) write_all(path, format, instants);
  per_frame(state, std::filesystem::file_size(path));
  std::filesystem::remove(path);
}

void read_format(benchmark::State& state, const char* format, const char* name) {
  const std::string path = location(name);
  write_all(path, format, all_instants());
  for (auto _ : state) {
    const auto reader = format::open_recording(path);
    while (const auto frame = reader->next()) benchmark::DoNotOptimize(frame->samples.data());
  }
  per_frame(state, std::filesystem::file_size(path));
  std::filesystem::remove(path);
}

/// A take with what 8 cameras saw: 50 markers each.
void write_take_of_cameras(benchmark::State& state) {
  const std::string path = location("bench_cameras.marey");
  const auto instants = all_instants(8);
  for (auto _ : state) {
    format::take::TakeWriter writer(path);
    write_all(writer, instants);
  }
  per_frame(state, std::filesystem::file_size(path));
  std::filesystem::remove(path);
}

/// One marker of 50 out of 30 minutes at 100 Hz, the file in the page cache. `flush_every` frames a chunk is written, as a live
/// recording does; 0: as fast as it comes.
void read_one_track(benchmark::State& state, int flush_every, bool finished) {
  const std::string path = location("bench_long.marey");
  {
    format::take::TakeWriter writer(path);
    writer.begin(header());
    Instant instant = instant_of(0);
    for (int i = 0; i < 30 * 60 * 100; ++i) {
      instant.index = i;
      instant.time = timestamp_from_seconds(0.01 * i);
      for (Sample& sample : instant.samples) sample.position.y() = 1e-3 * i;
      writer.write(instant);
      if (flush_every > 0 && i % flush_every == flush_every - 1) writer.flush();  // waits for the disk
    }
    if (finished) writer.finish();
  }
  for (auto _ : state) {
    const format::take::TakeReader reader(path);
    const TrackColumns track = reader.read_track(TrackId{17});
    if (track.size() != 30 * 60 * 100) state.SkipWithError("rows are missing");
    benchmark::DoNotOptimize(track.x().data());
  }
  state.counters["MB of the take"] = static_cast<double>(std::filesystem::file_size(path)) * 1e-6;
  std::filesystem::remove(path);
}

/// 90 minutes of 25 people at 25 Hz on the ground, with velocities and covariances: how large, and how fast.
void write_match(benchmark::State& state) {
  const std::string path = location("bench_match.marey");
  RecordingHeader ground = header();
  ground.frame.kind = FrameOfReference::Kind::ground;
  ground.rate_hz = 25;
  Instant instant;
  for (int p = 1; p <= 25; ++p) {
    Sample& sample = instant.samples.emplace_back();
    sample.track = TrackId(p);
    sample.velocity = Vector<3>(1.1, -0.3, 0);
    sample.covariance = Matrix<3>(Vector<3>(0.01, 0.02, 0).asDiagonal());
  }
  for (auto _ : state) {
    format::take::TakeWriter writer(path);
    writer.begin(ground);
    for (int i = 0; i < 90 * 60 * 25; ++i) {
      instant.index = i;
      instant.time = timestamp_from_seconds(0.04 * i);
      for (Sample& sample : instant.samples) {
        sample.position = {0.1 * (i % 1000) + number(sample.track), 0.07 * (i % 900), 0};
        sample.provenance = (i + number(sample.track)) % 50 == 0 ? Provenance::filled : Provenance::measured;
        sample.cameras = static_cast<CameraMask>(1 + (i / 100 + number(sample.track)) % 15);
      }
      writer.write(instant);
    }
    writer.finish();
  }
  state.counters["MB of the take"] = static_cast<double>(std::filesystem::file_size(path)) * 1e-6;
  std::filesystem::remove(path);
}

/// The bytes of a C3D file of this length, written and read with one call a frame and nothing else.
void write_unambiguously(benchmark::State& state) {
  const std::string path = location("bound.bin");
  const std::vector<float> row(4 * kMarkers, 1.0F);
  for (auto _ : state) {
    std::FILE* file = std::fopen(path.c_str(), "wb");
    for (int i = 0; i < kFrames; ++i) std::fwrite(row.data(), sizeof(float), row.size(), file);
    std::fclose(file);
  }
  per_frame(state, std::filesystem::file_size(path));
  std::filesystem::remove(path);
}

void read_unambiguously(benchmark::State& state) {
  const std::string path = location("bound.bin");
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

BENCHMARK(write_unambiguously)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(write_format, c3d, "c3d", "bench.c3d")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(write_format, take, "take", "bench.marey")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(write_format, trc, "trc", "bench.trc")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(write_format, csv, "csv", "bench.csv")->Unit(benchmark::kMillisecond);
BENCHMARK(write_take_of_cameras)->Unit(benchmark::kMillisecond);
BENCHMARK(write_match)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK_CAPTURE(read_one_track, whole, 0, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read_one_track, joined, 1000, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read_one_track, cut_off, 1000, false)->Unit(benchmark::kMillisecond);
BENCHMARK(read_unambiguously)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read_format, c3d, "c3d", "bench.c3d")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read_format, take, "take", "bench.marey")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read_format, trc, "trc", "bench.trc")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read_format, csv, "csv", "bench.csv")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace marey
