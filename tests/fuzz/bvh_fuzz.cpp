// Whatever a BVH file holds, reading it ends in a skeleton whose rows fit it, or in one Error.
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
    SkeletonFile file = parse_bvh(text, "file");
    marey::fuzz::check_skeleton(file.skeleton);
    if (file.motion) {
      check(file.motion->rate_hz > 0 && file.motion->rows.size() == file.motion->times.size());
      for (const auto& row : file.motion->rows) check(row.size() == file.skeleton.coordinates.size());
    }
    marey::fuzz::check_recording(std::move(file));
  } catch (const marey::Error& error) {
    marey::fuzz::check_lines(error.what());
  }
  return 0;
}
