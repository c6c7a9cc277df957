// Whatever bytes a file holds, reading it ends in frames or in one Error, in memory that the file's own size bounds.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string_view>

#include "marey/core/error.h"
#include "marey/format/motion/c3d.h"
#include "marey/format/motion/c3d_auxiliary.h"
#include "marey/format/motion/c3d_section.h"

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
      check(frame->bodies.size() <= reader->header().bodies.size());
      for (const marey::BodyPose& pose : frame->bodies) {
        const auto& rotated = pose.world_from_body.rotation;
        check(pose.world_from_body.translation.allFinite() &&
              (rotated * rotated.transpose() - marey::Matrix<3>::Identity()).norm() < 1e-9);
      }
    }
    // What would go along into another file.
    marey::format::motion::C3dAuxiliary auxiliary(std::as_bytes(std::span(data, size)), {.path = "file", .rotated = true});
    check(auxiliary.channels() * auxiliary.samples() * 2 <= size);
    check(auxiliary.frame(last).size() == auxiliary.channels() * auxiliary.samples());
    for (const char* group : {"ANALOG", "FORCE_PLATFORM", "EVENT"}) {
      marey::format::motion::C3dSection section;
      for (const auto& parameter : auxiliary.group(group, marey::format::UpAxis::z)) section.copy(parameter);
    }
  } catch (const marey::Error& error) {
    const std::string_view message = error.what();
    check(message.starts_with("file:") && message.find('\n') == std::string_view::npos);
  }
  return 0;
}
