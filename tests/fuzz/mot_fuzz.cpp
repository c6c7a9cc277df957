// Whatever bytes a file holds, reading it ends in boxes or in one Error, and boxes that are written read back the same.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "marey/core/error.h"
#include "marey/format/tracks/mot.h"

#include "fuzz.h"

using marey::fuzz::check;

namespace {

void read_and_write(std::string_view text, marey::format::tracks::MotKind kind) {
  marey::format::tracks::MotTable table;
  try {
    table = marey::format::tracks::parse_mot(text, "file", kind);
  } catch (const marey::Error& error) {
    const std::string_view message = error.what();
    check(message.starts_with("file:") && message.find('\n') == std::string_view::npos);
    return;
  }
  std::string written;
  for (const marey::LabelledBox& box : table.boxes) {
    check(std::isfinite(box.box.left) && std::isfinite(box.box.top) && box.frame >= 0 && !box.box.empty());
    marey::format::tracks::append_mot(written, box);
  }
  check(marey::format::tracks::parse_mot(written, "file", kind).boxes == table.boxes);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  for (const auto kind :
       {marey::format::tracks::MotKind::truth, marey::format::tracks::MotKind::tracks, marey::format::tracks::MotKind::detections})
    read_and_write(text, kind);
  return 0;
}
