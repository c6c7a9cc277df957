// Whatever bytes a take's file holds, reading it ends in frames or in one Error. The bytes go through a file in memory, as SQLite
// reads files only.
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "marey/core/error.h"
#include "marey/format/take/take_file.h"

#include "fuzz.h"

using marey::fuzz::check;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string& path = marey::fuzz::memory_file(marey::fuzz::text_of(data, size));
  try {
    marey::format::take::TakeReader reader(path);
    check(reader.header().rate_hz > 0);
    const auto summary = reader.summary();
    reader.edits();
    reader.warnings();
    reader.time_steps();
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
