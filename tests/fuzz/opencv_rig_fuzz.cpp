// OpenCV's YAML, JSON and XML, through OpenCV's own parser, whose code is not instrumented: a crash in it is found all the same.
#include "marey/core/error.h"
#include "marey/format/rig/imported_rig.h"
#include "marey/format/rig/rig_file.h"

#include "fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  marey::Rig rig;
  try {
    rig = marey::format::rig::parse_opencv_rig(std::string(marey::fuzz::text_of(data, size)), "file");
  } catch (const marey::Error& error) {
    marey::fuzz::check_message(error.what(), "file");
    return 0;
  }
  marey::fuzz::check(!rig.cameras.empty());
  marey::format::rig::parse_rig(marey::format::rig::rig_text(rig), "ours");
  return 0;
}
