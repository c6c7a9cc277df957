// Whatever a .mot or .sto file holds, reading it ends in rows as wide as its columns, or in one Error.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "marey/core/error.h"
#include "marey/format/skeleton/motion_table.h"
#include "marey/format/skeleton/skeleton_file.h"

#include "fuzz.h"
#include "skeleton.h"

using marey::fuzz::check;
using namespace marey::format::skeleton;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = marey::fuzz::text_of(data, size);
  try {
    const MotionTable table = parse_motion_table(text, "file");
    check(table.rows.size() == table.times.size());
    for (const auto& row : table.rows) check(row.size() == table.columns.size());
  } catch (const marey::Error& error) {
    marey::fuzz::check_lines(error.what());
  }
  return 0;
}
