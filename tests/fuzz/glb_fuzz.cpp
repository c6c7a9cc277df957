// Whatever a .glb file holds, its description is told or refused in one Error.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "marey/core/error.h"
#include "marey/format/skeleton/gltf.h"

#include "fuzz.h"
#include "skeleton.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    marey::fuzz::check(marey::format::skeleton::facts_of_glb(marey::fuzz::text_of(data, size), "file").size() >= 3);
  } catch (const marey::Error& error) {
    marey::fuzz::check_lines(error.what());
  }
  return 0;
}
