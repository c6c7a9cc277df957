// Whatever bytes a take's file holds, reading it ends in frames or in one Error. The bytes go through a file in memory, as SQLite
// reads files only.
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include <sys/mman.h>
#include <unistd.h>

#include "marey/core/error.h"
#include "marey/format/take/take_file.h"

namespace {

void check(bool holds) {
  if (!holds) std::abort();
}

const std::string& memory_file(const std::uint8_t* data, std::size_t size) {
  static const int file = memfd_create("take", 0);
  static const std::string path = "/proc/self/fd/" + std::to_string(file);
  check(ftruncate(file, 0) == 0 && pwrite(file, data, size, 0) == static_cast<ssize_t>(size));
  return path;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string& path = memory_file(data, size);
  try {
    marey::format::take::TakeReader reader(path);
    check(reader.header().rate_hz > 0);
    const auto summary = reader.summary();
    reader.edits();
    reader.warnings();
    reader.moments();
    for (int frames = 0; frames < 10'000; ++frames) {
      const auto frame = reader.next();
      if (!frame) break;
      for (const marey::Sample& sample : frame->samples) check(sample.position.allFinite());
    }
    for (std::size_t i = 0; i < summary.tracks.size() && i < 10; ++i) reader.read_track(summary.tracks[i].name.id);
  } catch (const marey::Error& error) {
    check(std::string_view(error.what()).starts_with(path));
  }
  return 0;
}
