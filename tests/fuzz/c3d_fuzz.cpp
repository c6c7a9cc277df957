// Whatever bytes a file holds, reading it ends in frames or in one Error, in memory that the file's own size bounds.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string_view>

#include "marey/core/error.h"
#include "marey/format/motion/c3d.h"

#include "fuzz.h"

using marey::fuzz::check;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const auto reader = marey::format::motion::read_c3d(std::as_bytes(std::span(data, size)), "file");
    check(reader->info().header.rate_hz > 0);
    std::int64_t last = -1;
    while (const auto frame = reader->next()) {
      check(frame->index > last);
      last = frame->index;
      for (const marey::Sample& point : frame->samples) check(point.position.allFinite());
    }
  } catch (const marey::Error& error) {
    const std::string_view message = error.what();
    check(message.starts_with("file:") && message.find('\n') == std::string_view::npos);
  }
  return 0;
}
