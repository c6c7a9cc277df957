#include "marey/core/rig.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "marey/core/error.h"

namespace marey {

std::optional<Camera> RigCamera::camera() const {
  if (!lens || !camera_from_world || !size) return std::nullopt;
  return Camera(*lens, *camera_from_world, *size);
}

std::optional<GroundView> RigCamera::ground_view(const geometry::GroundSurface& surface) const {
  if (const auto whole = camera()) return GroundView(*whole, surface);
  if (!ground_from_image || !size) return std::nullopt;
  return GroundView(*ground_from_image, *size);
}

bool unfit_for_camera_name(char c) {
  return static_cast<unsigned char>(c) < ' ' || c == '\x7f' || std::string_view("/\\,=\"").find(c) != std::string_view::npos;
}

std::string camera_names(const Rig& rig) {
  std::string all;
  for (const RigCamera& camera : rig.cameras) all += (all.empty() ? "" : ", ") + camera.name;
  return all;
}

RigCamera& camera_named(Rig& rig, const std::string& name) {
  const auto at = std::find_if(rig.cameras.begin(), rig.cameras.end(), [&](const RigCamera& each) { return each.name == name; });
  if (at == rig.cameras.end()) throw Error("the rig has no camera \"{}\"; there are: {}", name, camera_names(rig));
  return *at;
}

namespace {

/// Codecs work on blocks of 16 px: 1920 x 1080 are stored as 1920 x 1088, filled up at the right and at the bottom.
bool is_padded(cv::Size padded, cv::Size found) {
  const auto fills = [](int whole, int part) { return whole == part || whole == (part + 15) / 16 * 16; };
  return fills(padded.width, found.width) && fills(padded.height, found.height);
}

}  // namespace

void fit_to_size(RigCamera& camera, cv::Size found) {
  if (!camera.size || is_padded(*camera.size, found)) camera.size = found;
  if (*camera.size == found) return;
  const double factor = static_cast<double>(found.width) / camera.size->width;
  const bool same_shape = std::abs(camera.size->height * factor - found.height) <= std::max(1.0, factor);
  if (!same_shape) {
    throw Error(
        "camera \"{}\": its images are {} x {}, but it is calibrated for {} x {}, which has another shape; calibrate it at {} x "
        "{}",
        camera.name, found.width, found.height, camera.size->width, camera.size->height, found.width, found.height);
  }
  camera.size = found;
  for (Mask& mask : camera.masks) mask = mask.scaled(factor);
  if (camera.lens) camera.lens = geometry::scaled(*camera.lens, factor);
  if (camera.ground_from_image) {
    Matrix<3> calibrated_from_found = Matrix<3>::Identity();  // whole numbers are centres of pixels
    calibrated_from_found(0, 0) = calibrated_from_found(1, 1) = 1 / factor;
    calibrated_from_found(0, 2) = calibrated_from_found(1, 2) = 0.5 / factor - 0.5;
    *camera.ground_from_image = *camera.ground_from_image * calibrated_from_found;
  }
}

}  // namespace marey
