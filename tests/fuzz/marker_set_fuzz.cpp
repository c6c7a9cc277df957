// A marker set: whatever a file holds, reading it ends in names that occur once or in one Error.
#include <set>

#include "marey/core/error.h"
#include "marey/format/motion/marker_set.h"

#include "fuzz.h"

using marey::fuzz::check;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string& path = marey::fuzz::memory_file(marey::fuzz::text_of(data, size));
  try {
    const auto markers = marey::format::motion::read_marker_set(path);
    check(!markers.has_positions() || markers.locations.size() == markers.labels.size());
    check(std::set(markers.labels.begin(), markers.labels.end()).size() == markers.labels.size());
    for (const auto& location : markers.locations) check(location.allFinite());
  } catch (const marey::Error& error) {
    marey::fuzz::check_message(error.what(), path);
  }
  return 0;
}
