// Whatever an ASF file holds, reading it ends in a skeleton or in one Error; the same bytes as its AMC file end in rows that fit or
// in one Error.
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
    SkeletonFile file = parse_asf(text, "file");
    marey::fuzz::check_skeleton(file.skeleton);
    marey::fuzz::check_recording(file);
    file.motion = parse_amc(text, "file", file);
    for (const auto& row : file.motion->rows) check(row.size() == file.skeleton.coordinates.size());
    marey::fuzz::check_recording(std::move(file));
  } catch (const marey::Error& error) {
    marey::fuzz::check_lines(error.what());
  }
  return 0;
}
