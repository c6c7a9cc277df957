// Calibrations of other programs: whatever a file holds, reading it ends in a rig whose cameras are sound or in one Error. The
// input's first byte chooses the format.
#include <cmath>

#include "marey/core/error.h"
#include "marey/format/rig/imported_rig.h"
#include "marey/format/rig/rig_file.h"

#include "fuzz.h"

using marey::fuzz::check;

namespace {

marey::Rig parse(unsigned which, std::string_view text) {
  switch (which % 3) {
    case 0:
      return marey::format::rig::parse_aniposelib_rig(text, "file");
    case 1:
      return marey::format::rig::parse_qualisys_rig(text, "file");
    default:
      return marey::format::rig::parse_tsai_rig(text, "file");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  marey::Rig rig;
  try {
    rig = parse(data[0], marey::fuzz::text_of(data + 1, size - 1));
  } catch (const marey::Error& error) {
    marey::fuzz::check_message(error.what(), "file");
    return 0;
  }
  check(!rig.cameras.empty());
  // What was taken in is a rig of ours: it reads back.
  check(marey::format::rig::parse_rig(marey::format::rig::rig_text(rig), "ours").cameras.size() == rig.cameras.size());
  return 0;
}
