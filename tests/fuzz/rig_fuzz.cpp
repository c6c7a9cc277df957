// Whatever bytes a rig file holds, reading it ends in a rig or in one Error each line of which names the file, and a rig that is
// written reads back as the same text.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "marey/core/error.h"
#include "marey/format/rig/rig_file.h"

#include "fuzz.h"

using marey::fuzz::check;

namespace {

void check_message(std::string_view message) {
  while (!message.empty()) {
    const std::string_view line = message.substr(0, message.find('\n'));
    check(line.starts_with("file:"));
    for (const char c : line) check(static_cast<unsigned char>(c) >= ' ' && c != '\x7f');
    message.remove_prefix(std::min(message.size(), line.size() + 1));
  }
}

void check_camera(const marey::RigCamera& camera) {
  check(!camera.name.empty() && std::isfinite(camera.offset_s.value_or(0)));
  if (camera.size) check(camera.size->width > 0 && camera.size->height > 0);
  if (camera.lens)
    check(marey::geometry::focal_of(*camera.lens).minCoeff() > 0 && marey::geometry::principal_of(*camera.lens).allFinite());
  if (camera.camera_from_world) {
    const auto& R = camera.camera_from_world->rotation;
    check((R * R.transpose() - marey::Matrix<3>::Identity()).norm() < 1e-8 && R.determinant() > 0);
  }
  if (const auto whole = camera.camera()) {
    const auto detected = whole->project({0.1, 0.2, 0.3});
    check(!detected || detected->allFinite());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  marey::Rig rig;
  try {
    rig = marey::format::rig::parse_rig({reinterpret_cast<const char*>(data), size}, "file");
  } catch (const marey::Error& error) {
    check_message(error.what());
    return 0;
  }
  for (const marey::RigCamera& camera : rig.cameras) check_camera(camera);
  const std::string text = marey::format::rig::rig_text(rig);
  check(marey::format::rig::rig_text(marey::format::rig::parse_rig(text, "file")) == text);
  return 0;
}
