#include "marey/format/rig/imported_rig.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <Eigen/LU>
#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/files/input_file.h"
#include "marey/files/text_safety.h"
#include "marey/geometry/decompositions.h"
#include "marey/geometry/lens_fit.h"

namespace marey::format::rig {
namespace {

constexpr double kNearEnough = 0.05;  // px RMS, of a lens that stands for another

constexpr double kMaxInRig = 1e9;  // of any number in a rig

bool is_sound(double value) {
  return std::abs(value) < kMaxInRig;
}

/// A pixel's direction through a whole lens.
std::optional<Vector<3>> bearing(const geometry::Lens& lens, cv::Size size, const Vector<2>& pixel) {
  return Camera(lens, Rigid3{}, size).bearing(pixel);
}

/// A name that is fit for a rig.
std::string fit_name(std::string name) {
  name = plain_text(name);
  std::replace_if(name.begin(), name.end(), unfit_for_camera_name, '_');
  return name;
}

void check_rotation(Matrix<3>& rotation, const std::string& path, const std::string& name) {
  const double off = (rotation.transpose() * rotation - Matrix<3>::Identity()).cwiseAbs().maxCoeff();
  if (!(off < 1e-2))
    throw Error("{}: camera \"{}\": its rotation is not one: rows must have length 1 and be perpendicular", path, name);
  if (rotation.determinant() < 0) throw Error("{}: camera \"{}\": its rotation is a mirroring (determinant -1)", path, name);
  if (off < 1e-9) return;
  const geometry::SingularValues3 svd = geometry::singular_values(rotation);
  rotation = svd.U * svd.V.transpose();
}

}  // namespace

bool is_xml(const Beginning& file) {
  const std::size_t first = file.text().find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && file.text()[first] == '<';
}

void check_imported(Rig& rig, const std::string& path) {
  if (rig.cameras.empty()) throw Error("{}: there is no camera in it", path);
  std::set<std::string> names;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    RigCamera& camera = rig.cameras[i];
    camera.name = camera.name.empty() ? fmt::format("cam{}", i + 1) : fit_name(camera.name);
    if (!names.insert(camera.name).second)
      throw Error("{}: two cameras are named \"{}\"; each needs its own name", path, camera.name);
    if (camera.size &&
        (camera.size->width < 1 || camera.size->height < 1 || camera.size->width > 100'000 || camera.size->height > 100'000)) {
      throw Error("{}: camera \"{}\": its image of {} x {} px is not one", path, camera.name, camera.size->width,
                  camera.size->height);
    }
    if (camera.lens) {
      const double focal = geometry::focal_of(*camera.lens).minCoeff();
      if (!(focal > 0) || !(geometry::focal_of(*camera.lens).maxCoeff() < 1e9)) {
        throw Error("{}: camera \"{}\": focal length is {}; it must be positive", path, camera.name, focal);
      }
      const bool sound =
          (geometry::principal_of(*camera.lens).array().abs() < kMaxInRig).all() &&
          std::visit([](const auto& lens) { return std::all_of(lens.distortion.begin(), lens.distortion.end(), is_sound); },
                     *camera.lens);
      if (!sound) throw Error("{}: camera \"{}\": its lens has numbers that are not finite, or beyond 1e9", path, camera.name);
    }
    if (camera.rms_px && !is_sound(*camera.rms_px)) camera.rms_px.reset();
    if (!camera.camera_from_world) continue;
    check_rotation(camera.camera_from_world->rotation, path, camera.name);
    if (!(camera.camera_from_world->translation.array().abs() < kMaxInRig).all())
      throw Error("{}: camera \"{}\": its place is not finite, or beyond 1e9 m", path, camera.name);
  }
}

geometry::BrownLens as_brown(const RigCamera& camera, int coefficients, std::string_view format) {
  if (!camera.lens || !camera.size)
    throw Error("camera \"{}\": its lens or size is missing, which {} needs; calibrate it first", camera.name, format);
  const auto* brown = std::get_if<geometry::BrownLens>(&*camera.lens);
  const auto unused = [&](const geometry::BrownLens& lens) {
    return std::all_of(lens.distortion.begin() + coefficients, lens.distortion.end(), [](double k) { return k == 0; });
  };
  if (brown != nullptr && unused(*brown)) return *brown;
  geometry::BrownLens start;
  start.focal = geometry::focal_of(*camera.lens);
  start.principal = geometry::principal_of(*camera.lens);
  const auto fit = geometry::fit_brown([&](const Vector<2>& pixel) { return bearing(*camera.lens, *camera.size, pixel); },
                                       *camera.size, start, {.coefficients = coefficients, .turn = false});
  if (!fit || fit->rms_px > kNearEnough) {
    throw Error("camera \"{}\": {} cannot hold its lens ({}){}; write a format that can: marey, opencv", camera.name, format,
                geometry::name_of(*camera.lens), fit ? fmt::format(": the nearest is {:.2f} px off", fit->rms_px) : "");
  }
  return fit->lens;
}

}  // namespace marey::format::rig
