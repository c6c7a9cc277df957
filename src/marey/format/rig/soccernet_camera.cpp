#include "marey/format/rig/soccernet_camera.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "marey/core/error.h"
#include "marey/files/whole_file.h"
#include "marey/format/format.h"
#include "marey/format/nesting.h"
#include "marey/format/read_file.h"
#include "marey/format/rig/imported_rig.h"

namespace marey::format::rig {
namespace {

using nlohmann::json;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kMaxPositionDistance = 1e5;  // m
constexpr double kMaxFocal = 1e7;             // px

/// Ours from theirs, without the shift of the origin: y and z turned over.
Matrix<3> rotated_over() {
  return Vector<3>(1, -1, -1).asDiagonal();
}

Vector<3> corner_of(const geometry::PitchSize& size) {
  return {size.length / 2, size.width / 2, 0};
}

struct Angles {
  double pan = 0, tilt = 0, roll = 0;
};

/// World from camera: turned by roll about z, by tilt about x, by pan about z.
Matrix<3> rotation_of(const Angles& angles) {
  const auto about = [](double angle, const Vector<3>& axis) { return geometry::rotation_from(angle * axis); };
  return about(angles.pan, Vector<3>::UnitZ()) * about(angles.tilt, Vector<3>::UnitX()) * about(angles.roll, Vector<3>::UnitZ());
}

/// Of the two answers the one with the camera upright.
Angles angles_of(const Matrix<3>& world_from_camera) {
  const Matrix<3>& R = world_from_camera;
  const double tilt = std::acos(std::clamp(R(2, 2), -1.0, 1.0));
  if (std::sin(tilt) < 1e-12) return {std::atan2(R(1, 0), R(0, 0)), tilt, 0};
  const Angles one{std::atan2(R(0, 2), -R(1, 2)), tilt, std::atan2(R(2, 0), R(2, 1))};
  if (std::abs(one.roll) <= std::numbers::pi / 2) return one;
  return {std::atan2(-R(0, 2), R(1, 2)), -tilt, std::atan2(-R(2, 0), -R(2, 1))};
}

class CameraReader {
 public:
  CameraReader(std::string_view text, const std::string& name) : name_(name) {
    check_nesting(text, Notation::json, name);
    try {
      root_ = json::parse(text);
    } catch (const json::parse_error& error) {
      throw Error("{}: is not JSON: it breaks off or is wrong at byte {}", name, error.byte);
    }
    if (!root_.is_object()) throw Error("{}: is not a camera of SoccerNet: it must be an object", name);
  }

  double number(const char* key, double maximum) const { return checked(at(key), key, maximum); }

  std::vector<double> numbers(const char* key, std::size_t count, double maximum) const {
    const json& list = at(key);
    if (!list.is_array() || list.size() != count) throw Error("{}: \"{}\" must be a list of {} numbers", name_, key, count);
    std::vector<double> values;
    for (const json& value : list) values.push_back(checked(value, key, maximum));
    return values;
  }

  bool has(const char* key) const { return root_.contains(key); }

 private:
  const json& at(const char* key) const {
    const auto found = root_.find(key);
    if (found == root_.end()) throw Error("{}: \"{}\" is missing, which a camera of SoccerNet has", name_, key);
    return *found;
  }

  double checked(const json& value, const char* key, double maximum) const {
    if (!value.is_number() || !(std::abs(value.get<double>()) <= maximum))
      throw Error("{}: \"{}\" must be a number, {} at most", name_, key, maximum);
    return value.get<double>();
  }

  std::string name_;
  json root_;
};

/// The even number of pixels whose middle is there, whether pixels are counted by their corners or their centres.
int size_about(double principal) {
  const int whole = static_cast<int>(std::lround(2 * principal));
  return whole + whole % 2;
}

geometry::BrownLens lens_of(const CameraReader& file, const std::string& name) {
  geometry::BrownLens lens;
  lens.focal = {file.number("x_focal_length", kMaxFocal), file.number("y_focal_length", kMaxFocal)};
  if (!(lens.focal.minCoeff() > 0)) throw Error("{}: focal lengths must be positive", name);
  const auto principal = file.numbers("principal_point", 2, 1e5);
  lens.principal = {principal[0], principal[1]};
  if (!(lens.principal.minCoeff() >= 1)) throw Error("{}: \"principal_point\" must lie in the image", name);
  if (file.has("radial_distortion")) {
    const auto k = file.numbers("radial_distortion", 6, 1e6);
    lens.distortion[0] = k[0], lens.distortion[1] = k[1];
    std::copy(k.begin() + 2, k.end(), lens.distortion.begin() + 4);
  }
  if (file.has("tangential_distortion")) {
    const auto p = file.numbers("tangential_distortion", 2, 1e6);
    lens.distortion[2] = p[0], lens.distortion[3] = p[1];
  }
  if (file.has("thin_prism_distortion")) {
    for (const double value : file.numbers("thin_prism_distortion", 4, 1e6)) {
      if (value != 0) throw Error("{}: has thin prism distortion, which cannot be read; calibrate without it", name);
    }
  }
  return lens;
}

Rig read_rig_of_one(const std::string& path) {
  const Camera camera = parse_soccernet_camera(read_file(path), path, {});
  Rig rig;
  RigCamera& one = rig.cameras.emplace_back();
  one.name = std::filesystem::path(path).stem().string();
  one.size = camera.size(), one.lens = camera.lens(), one.camera_from_world = camera.camera_from_world();
  check_imported(rig, path);
  return rig;
}

void write_rig_of_one(const Rig& rig, const std::string& path) {
  if (rig.cameras.size() != 1) throw Error("{}: SoccerNet's file holds one camera, and the rig has {}", path, rig.cameras.size());
  const auto camera = rig.cameras[0].camera();
  if (!camera) throw Error("camera \"{}\": its lens, size or pose is missing; calibrate it first", rig.cameras[0].name);
  const geometry::BrownLens lens = as_brown(rig.cameras[0], 8, "SoccerNet's camera file");
  WholeFile file(path);
  file.write(soccernet_camera_text(Camera(lens, camera->camera_from_world(), camera->size()), {}));
  file.finish();
}

}  // namespace

std::string soccernet_camera_text(const Camera& camera, const geometry::PitchSize& size) {
  const auto* lens = std::get_if<geometry::BrownLens>(&camera.lens());
  if (lens == nullptr) throw Error("SoccerNet's camera file knows the lens model brown alone, not {}", name_of(camera.lens()));
  const Vector<3> location = rotated_over() * (camera.centre() - corner_of(size));
  const Angles angles = angles_of(rotated_over() * camera.camera_from_world().rotation.transpose());
  const auto& k = lens->distortion;
  return fmt::format(
      "{{\n  \"pan_degrees\": {:.10g},\n  \"tilt_degrees\": {:.10g},\n  \"roll_degrees\": {:.10g},\n"
      "  \"position_meters\": [{:.10g}, {:.10g}, {:.10g}],\n  \"x_focal_length\": {:.10g},\n  \"y_focal_length\": {:.10g},\n"
      "  \"principal_point\": [{:.10g}, {:.10g}],\n  \"radial_distortion\": [{:.10g}, {:.10g}, {:.10g}, {:.10g}, {:.10g}, "
      "{:.10g}],\n"
      "  \"tangential_distortion\": [{:.10g}, {:.10g}],\n  \"thin_prism_distortion\": [0.0, 0.0, 0.0, 0.0]\n}}\n",
      angles.pan / kDegree, angles.tilt / kDegree, angles.roll / kDegree, location.x(), location.y(), location.z(), lens->focal.x(),
      lens->focal.y(), lens->principal.x(), lens->principal.y(), k[0], k[1], k[4], k[5], k[6], k[7], k[2], k[3]);
}

Camera parse_soccernet_camera(std::string_view text, const std::string& name, const geometry::PitchSize& size) {
  const CameraReader file(text, name);
  const Angles angles{kDegree * file.number("pan_degrees", 1e4), kDegree * file.number("tilt_degrees", 1e4),
                      kDegree * file.number("roll_degrees", 1e4)};
  const auto location = file.numbers("position_meters", 3, kMaxPositionDistance);
  const geometry::BrownLens lens = lens_of(file, name);
  Rigid3 pose;
  pose.rotation = rotation_of(angles).transpose() * rotated_over();
  const Vector<3> centre = rotated_over() * Vector<3>(location[0], location[1], location[2]) + corner_of(size);
  pose.translation = -(pose.rotation * centre);
  return {lens, pose, cv::Size(size_about(lens.principal.x()), size_about(lens.principal.y()))};
}

Format soccernet_camera_format() {
  return {.name = "soccernet",
          .title = "a camera of SoccerNet's calibration",
          .endings = {},
          .holds = Content::rig,
          .detail =
              "JSON of one camera of a pitch of 105 x 68 m, degrees, m from its middle, z down; the image's size is twice the "
              "principal point",
          .is = [](const Beginning& file) { return file.is_text() && file.has("\"pan_degrees\"") && file.has("\"tilt_degrees\""); },
          .read_rig = read_rig_of_one,
          .write_rig = write_rig_of_one};
}

}  // namespace marey::format::rig
