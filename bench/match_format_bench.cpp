// A match of 90 minutes, 25 people at 25 Hz, read and written as our CSV and as TRACAB, beside writing and reading the same bytes
// plainly (the bound).
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "marey/format/recording_file.h"
#include "marey/format/register.h"

namespace marey {
namespace {

constexpr int kPeople = 25;
constexpr int kFrames = 90 * 60 * 25;

const format::match::GroundMatch& match() {
  static const format::match::GroundMatch all = [] {
    format::match::GroundMatch one;
    one.recording.header.rig.emplace();
    for (const char* camera : {"left", "right"}) one.recording.header.rig->cameras.emplace_back().name = camera;
    for (std::int32_t frame = 0; frame < kFrames; ++frame)
      one.recording.add_time_step({frame, timestamp_from_seconds(frame / 25.0)});
    for (int id = 1; id <= kPeople; ++id) {
      TrackColumns track({TrackId{id}, std::to_string(id), id <= 11 ? "white" : id <= 22 ? "blue" : "referee"}, 2);
      track.reserve(kFrames);
      for (std::int32_t frame = 0; frame < kFrames; ++frame) {
        const double phase = 0.001 * frame + id - 1;
        Sample sample;
        sample.position = {52 + 40 * std::sin(phase), 34 + 30 * std::cos(1.3 * phase), 0};
        sample.velocity = Vector<3>(std::cos(phase), -0.9 * std::sin(1.3 * phase), 0);
        sample.cameras = 3;
        track.add(frame, sample);
      }
      one.recording.put(std::move(track));
    }
    return one;
  }();
  return all;
}

struct Location {
  explicit Location(const char* name)
      : folder(std::filesystem::temp_directory_path() / "marey_match_bench"), path((folder / name).string()) {
    std::filesystem::create_directories(folder);
  }
  ~Location() { std::filesystem::remove_all(folder); }
  std::filesystem::path folder;
  std::string path;
};

void count_bytes(benchmark::State& state, std::size_t bytes) {
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations()) * static_cast<std::int64_t>(bytes));
  state.counters["rows/s"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * kPeople * kFrames, benchmark::Counter::kIsRate);
}

void write_match(benchmark::State& state, const char* format, const char* name) {
  const Location location(name);
  const format::match::GroundMatch& all = match();
  for (auto _ : state) format::write_whole(location.path, *format::format_named(format, format::Content::ground), all);
  count_bytes(state, std::filesystem::file_size(location.path));
}

void read_match(benchmark::State& state, const char* format, const char* name) {
  const Location location(name);
  format::write_whole(location.path, *format::format_named(format, format::Content::ground), match());
  for (auto _ : state) benchmark::DoNotOptimize(format::read_match(location.path).recording.samples());
  count_bytes(state, std::filesystem::file_size(location.path));
}

constexpr std::size_t kPlainBytes = std::size_t{75} * kPeople * kFrames;  // about those of the CSV

void write_bytes(benchmark::State& state) {
  const Location location("plain.bin");
  const std::string piece(std::size_t{1} << 20, 'x');
  for (auto _ : state) {
    std::FILE* file = std::fopen(location.path.c_str(), "wb");
    for (std::size_t done = 0; done < kPlainBytes; done += piece.size()) std::fwrite(piece.data(), 1, piece.size(), file);
    std::fclose(file);
  }
  count_bytes(state, kPlainBytes);
}

void read_bytes(benchmark::State& state) {
  const Location location("plain.bin");
  std::string piece(std::size_t{1} << 20, 'x');
  std::FILE* out = std::fopen(location.path.c_str(), "wb");
  for (std::size_t done = 0; done < kPlainBytes; done += piece.size()) std::fwrite(piece.data(), 1, piece.size(), out);
  std::fclose(out);
  for (auto _ : state) {
    std::FILE* file = std::fopen(location.path.c_str(), "rb");
    while (std::fread(piece.data(), 1, piece.size(), file) == piece.size()) benchmark::DoNotOptimize(piece.data());
    std::fclose(file);
  }
  count_bytes(state, kPlainBytes);
}

BENCHMARK(write_bytes)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK_CAPTURE(write_match, csv, "ground", "bench.csv")->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK_CAPTURE(write_match, tracab, "tracab", "bench.dat")->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(read_bytes)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK_CAPTURE(read_match, csv, "ground", "bench.csv")->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK_CAPTURE(read_match, tracab, "tracab", "bench.dat")->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace
}  // namespace marey
