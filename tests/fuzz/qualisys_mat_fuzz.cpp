// Whatever a MAT-file holds, reading it ends in frames or in one Error.
#include <cstdint>
#include <cstdlib>

#include "marey/core/error.h"
#include "marey/format/motion/motion_csv.h"

#include "fuzz.h"

using marey::fuzz::check;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const auto reader = marey::format::motion::read_qualisys_mat(marey::fuzz::text_of(data, size), "file");
    check(reader->info().header.rate_hz > 0);
    while (const auto frame = reader->next()) {
      for (const marey::Sample& point : frame->samples) check(point.position.allFinite());
      for (const marey::BodyPose& pose : frame->bodies) check(pose.world_from_body.rotation.allFinite());
    }
  } catch (const marey::Error& error) {
    marey::fuzz::check_message(error.what(), "file");
  }
  return 0;
}
