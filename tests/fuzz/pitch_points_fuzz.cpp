// Clicks in a picture of a pitch, CSV or CVAT's XML: whatever a file holds, reading it ends in finite points or in one Error.
#include "marey/core/error.h"
#include "marey/format/pitch_points.h"

#include "fuzz.h"

using marey::fuzz::check;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const auto clicks = marey::format::parse_pitch_clicks(marey::fuzz::text_of(data, size), "file");
    check(!clicks.points.empty() || !clicks.lines.empty());
    for (const auto& point : clicks.points) check(point.ground.allFinite() && point.pixel.allFinite());
    for (const auto& line : clicks.lines) check(line.from != line.to);
  } catch (const marey::Error& error) {
    marey::fuzz::check_message(error.what(), "file");
  }
  return 0;
}
