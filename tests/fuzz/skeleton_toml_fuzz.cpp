// Whatever a skeleton.toml holds, reading it ends in a skeleton that reads again as it is written, or in one Error each line of
// which names the file.
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
    const marey::Skeleton skeleton = parse_toml(text, "file").skeleton;
    marey::fuzz::check_skeleton(skeleton);
    check(parse_toml(to_toml(skeleton), "file").skeleton.segments.size() == skeleton.segments.size());
  } catch (const marey::Error& error) {
    marey::fuzz::check_lines(error.what());
  }
  return 0;
}
