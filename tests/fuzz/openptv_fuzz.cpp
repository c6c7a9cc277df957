// A working folder of OpenPTV's: the input's parts, a zero byte between them, are its files in the order below. Whatever they hold,
// reading them ends in a rig whose cameras are sound or in one Error.
#include <array>

#include "marey/core/error.h"
#include "marey/format/register.h"
#include "marey/format/rig/rig_file.h"

#include "fuzz.h"

namespace {

constexpr std::array kFiles{"parameters/ptv.par", "cal/cam1.tif.ori", "cal/cam1.tif.addpar", "cal/cam2.tif.ori",
                            "cal/cam2.tif.addpar"};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string& folder = marey::fuzz::folder_of_files(kFiles, marey::fuzz::text_of(data, size));
  try {
    const marey::Rig rig = marey::format::format_named("openptv", marey::format::Content::rig)->read_rig(folder);
    marey::fuzz::check(!rig.cameras.empty());
    // What was taken in is a rig of ours: it reads back.
    marey::fuzz::check(marey::format::rig::parse_rig(marey::format::rig::rig_text(rig), "ours").cameras.size() ==
                       rig.cameras.size());
  } catch (const marey::Error& error) {
    marey::fuzz::check_message(error.what(), "");  // it names the file, which may lie anywhere
  }
  return 0;
}
