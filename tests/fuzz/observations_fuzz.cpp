// Observations: whatever a table holds, reading it ends in frames by growing index or in one Error.
#include "marey/core/error.h"
#include "marey/format/observations.h"

#include "fuzz.h"

using marey::fuzz::check;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string& path = marey::fuzz::memory_file(marey::fuzz::text_of(data, size));
  try {
    marey::Rig rig = marey::format::rig_of_observations(path);
    if (rig.cameras.size() > 64) rig.cameras.resize(64);
    marey::format::ObservationReader reader(path, rig);
    std::int64_t last = -1;
    while (const auto frame = reader.next()) {
      check(frame->frame > last);
      last = frame->frame;
      for (const auto& point : frame->points) check(point.pixel.allFinite());
    }
  } catch (const marey::Error& error) {
    marey::fuzz::check_message(error.what(), path);
  }
  return 0;
}
