// A folder of MultiCamSelfCal's: the input's parts, a zero byte between them, are its files in the order below. Whatever they hold,
// reading them ends in numbers or in one Error.
#include <array>
#include <filesystem>
#include <fstream>

#include "marey/core/error.h"
#include "marey/format/observations.h"
#include "marey/format/rig/imported_rig.h"
#include "marey/format/rig/self_cal_folder.h"

#include "fuzz.h"

namespace {

constexpr std::array kFiles{"points.dat",       "IdMat.dat",           "Res.dat",          "camera1.Pmat.cal",
                            "basename1.rad",    "cam1.points4cal.dat", "camera_order.txt", "Pmatrices.dat",
                            "camera2.Pmat.cal", "cam2.points4cal.dat", "basename2.rad",    "calibration_units.txt"};

const std::string& folder_of(std::string_view parts) {
  static const std::string folder =
      (std::filesystem::temp_directory_path() / ("self_cal_fuzz_" + std::to_string(getpid()))).string();
  std::filesystem::remove_all(folder);
  std::filesystem::create_directory(folder);
  for (const char* name : kFiles) {
    const std::string_view part = parts.substr(0, parts.find('\0'));
    if (!part.empty()) std::ofstream(std::filesystem::path(folder) / name, std::ios::binary) << part;
    parts.remove_prefix(std::min(parts.size(), part.size() + 1));
  }
  return folder;
}

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
  const std::string& folder = folder_of(marey::fuzz::text_of(data, size));
  survives(folder, [&] { marey::format::rig::read_self_cal_rig(folder); });
  survives(folder, [&] {
    for (const auto& point : marey::format::rig::SelfCalFolder(folder).points())
      marey::fuzz::check(point.pixel.allFinite() && point.frame >= 0);
  });
  return 0;
}
