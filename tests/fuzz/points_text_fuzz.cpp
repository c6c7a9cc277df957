// TRC and the kinds of CSV and TSV: whatever a file holds, reading it ends in frames or in one Error, by growing index, each marker
// once.
#include <array>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <string_view>

#include "marey/core/error.h"
#include "marey/format/motion/motion_csv.h"
#include "marey/format/motion/trc.h"

#include "fuzz.h"

using marey::fuzz::check;

namespace {

void walk(marey::format::FileReader& reader) {
  check(reader.info().header.rate_hz > 0);
  std::int64_t last = -1;
  while (const auto frame = reader.next()) {
    check(frame->index > last);
    last = frame->index;
    std::set<marey::TrackId> detected;
    for (const marey::Sample& point : frame->samples) {
      check(point.position.allFinite() && marey::number(point.track) > 0 && detected.insert(point.track).second);
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  for (const auto read :
       {marey::format::motion::read_trc, marey::format::motion::read_tidy_csv, marey::format::motion::read_motive_csv,
        marey::format::motion::read_nexus_csv, marey::format::motion::read_qualisys_tsv}) {
    try {
      walk(*read(text, "file"));
    } catch (const marey::Error& error) {
      const std::string_view message = error.what();
      check(message.starts_with("file:") && message.find('\n') == std::string_view::npos);
    }
  }
  return 0;
}
