// A folder of MultiCamSelfCal's: the input's parts, a zero byte between them, are its files in the order below. Whatever they hold,
// reading them ends in numbers or in one Error.
#include <array>

#include "marey/core/error.h"
#include "marey/format/observations.h"
#include "marey/format/rig/imported_rig.h"
#include "marey/format/rig/self_cal_folder.h"

#include "fuzz.h"

namespace {

constexpr std::array kFiles{"points.dat",       "IdMat.dat",           "Res.dat",          "camera1.Pmat.cal",
                            "basename1.rad",    "cam1.points4cal.dat", "camera_order.txt", "Pmatrices.dat",
                            "camera2.Pmat.cal", "cam2.points4cal.dat", "basename2.rad",    "calibration_units.txt"};

template <typename Read>
void survives(const std::string& folder, Read read) {
  try {
    read();
  } catch (const marey::Error& error) {
    marey::fuzz::check_message(error.what(), folder);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string& folder = marey::fuzz::folder_of_files(kFiles, marey::fuzz::text_of(data, size));
  survives(folder, [&] { marey::format::rig::read_self_cal_rig(folder); });
  survives(folder, [&] {
    for (const auto& point : marey::format::rig::SelfCalFolder(folder).points())
      marey::fuzz::check(point.pixel.allFinite() && point.frame >= 0);
  });
  return 0;
}
