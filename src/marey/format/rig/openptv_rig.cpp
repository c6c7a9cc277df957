// Cameras of OpenPTV (three-dimensional particle tracking): a working folder with parameters/ptv.par, which says how large images
// and pixels are and names the cameras' calibration images, and beside each of those CAMERA.ori (where the camera is, mm) and
// CAMERA.addpar (its lens). A camera there faces along −z with y up:
//
//   (a, b, c) = Rᵀ (P − C),   x = −cc a / c + xh,   y = −cc b / c + yh   (mm on the sensor)
//   x' = x (1 + k1 r² + k2 r⁴ + k3 r⁶) + p1 (r² + 2 x²) + 2 p2 x y,   y' likewise with p2, p1,   r² = x² + y²
//   u = scx (x' − sin(she) y') / pix_x + imx / 2,   v = imy / 2 − scx cos(she) y' / pix_y,
//
// whose u of a pixel's centre is a whole number and a half. That both axes have scx, and the half, is what its library does
// (tests/clients/openptv_test.py asks it). Rays that glass and water bend are refused.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/format/read_file.h"
#include "marey/format/rig/imported_rig.h"
#include "marey/format/text_rows.h"
#include "marey/geometry/lens_fit.h"

namespace marey::format::rig {
namespace {

namespace fs = std::filesystem;

constexpr double kMillimetres = 1e-3;
constexpr std::int64_t kMaxPtvCameras = 1000;
constexpr double kLensNearEnough = 0.5;  // px RMS, of the lens that stands for OpenPTV's
constexpr int kUndistortSteps = 50;

bool is_there(const fs::path& path) {
  std::error_code error;  // for names that no file can have
  return fs::exists(path, error);
}

/// What parameters/ptv.par says.
struct PtvControl {
  std::vector<std::string> cameras;  ///< calibration images, as the file names them
  cv::Size size;
  Vector<2> pixel = Vector<2>::Ones();  ///< mm
};

PtvControl control_of(const std::string& path) {
  const std::string text = read_file(path);
  TextLines lines(text);
  std::string_view line;
  const auto next = [&](const char* what) {
    if (!lines.next(line)) throw Error("{}: the file ends before {}; is it OpenPTV's ptv.par?", path, what);
    while (!line.empty() && static_cast<unsigned char>(line.back()) <= ' ') line.remove_suffix(1);
    while (!line.empty() && static_cast<unsigned char>(line.front()) <= ' ') line.remove_prefix(1);
    return line;
  };
  const auto number = [&](const char* what) {
    const auto value = number_of(next(what));
    if (!value) throw Error("{}:{}: {} is {}, which is no number", path, lines.number(), what, shown(line));
    return *value;
  };
  const double count = number("the number of cameras");
  if (!(count >= 1 && count <= kMaxPtvCameras) || count != std::floor(count))
    throw Error("{}:1: {} cameras; OpenPTV's ptv.par begins with their number, 1 to {}", path, count, kMaxPtvCameras);
  PtvControl control;
  for (int i = 0; i < static_cast<int>(count); ++i) {
    next("all cameras are named");
    control.cameras.emplace_back(next("all cameras are named"));
    std::replace(control.cameras.back().begin(), control.cameras.back().end(), '\\', '/');  // of a folder made under Windows
    const std::string& image = control.cameras.back();
    if (image.empty()) throw Error("{}:{}: camera {} has no calibration image", path, lines.number(), i + 1);
    if (std::any_of(image.begin(), image.end(), [](unsigned char c) { return c < ' ' || c == '\x7f'; }))
      throw Error("{}:{}: control characters in the name of camera {}'s calibration image", path, lines.number(), i + 1);
  }
  for (const char* flag : {"the high-pass flag", "the flag of all cameras", "the TIFF flag"}) number(flag);
  const double width = number("the images' width"), height = number("the images' height");
  control.size = {cv::saturate_cast<int>(width), cv::saturate_cast<int>(height)};
  for (int axis = 0; axis < 2; ++axis) control.pixel[axis] = number("the size of a pixel");
  if (!(control.pixel.minCoeff() > 0) || control.size.empty())
    throw Error("{}: images of {} x {} px of {} x {} mm are not any", path, width, height, control.pixel.x(), control.pixel.y());
  number("the interlacing");
  const std::array<double, 3> index{number("the refractive index of air"), number("that of glass"), number("that of water")};
  if (index[0] != index[1] || index[1] != index[2]) {
    throw Error(
        "{}: these cameras look through media of refractive indices {}, {} and {}, which bend their rays; Marey's cameras "
        "look through one",
        path, index[0], index[1], index[2]);
  }
  return control;
}

/// All numbers of a file, at least `fewest` of them.
std::vector<double> ptv_numbers(const std::string& path, std::size_t min_count, const char* what) {
  const std::string text = read_file(path);
  std::vector<double> values;
  for_each_line(text, path, [&](std::string_view line, const std::string& where) {
    while (true) {
      const auto first = line.find_first_not_of(" \t\r");
      if (first == std::string_view::npos) return;
      line.remove_prefix(first);
      const std::string_view word = line.substr(0, line.find_first_of(" \t\r"));
      const auto value = number_of(word);
      if (!value) throw Error("{}: {} is no number; is this {}?", where, shown(word), what);
      values.push_back(*value);
      line.remove_prefix(word.size());
    }
  });
  if (values.size() < min_count) throw Error("{}: {} numbers, and {} has {} or more", path, values.size(), what, min_count);
  return values;
}

/// OpenPTV's lens, mm.
struct PtvLens {
  double cc = 0;
  Vector<2> offset = Vector<2>::Zero();  ///< xh, yh
  std::array<double, 3> k{};
  std::array<double, 2> p{};
  double scale = 1, shear = 0;

  bool bends() const { return k != std::array<double, 3>{} || p != std::array<double, 2>{}; }

  Vector<2> distorted(const Vector<2>& at) const {
    const double r2 = at.squaredNorm(), x = at.x(), y = at.y();
    const double radial = r2 * (k[0] + r2 * (k[1] + r2 * k[2]));
    return {x + x * radial + p[0] * (r2 + 2 * x * x) + 2 * p[1] * x * y,
            y + y * radial + p[1] * (r2 + 2 * y * y) + 2 * p[0] * x * y};
  }

  /// The direction of a place on the sensor; nothing if no undistorted place is found.
  std::optional<Vector<3>> direction(const Vector<2>& sensor) const {
    const double y = sensor.y() / (scale * std::cos(shear));
    const Vector<2> bent(sensor.x() / scale + std::sin(shear) * y, y);
    Vector<2> straight = bent;
    for (int i = 0; i < kUndistortSteps; ++i) straight += bent - distorted(straight);
    if (!((bent - distorted(straight)).norm() < 1e-6 * cc)) return std::nullopt;
    const Vector<2> flat = straight - offset;
    return Vector<3>(flat.x() / cc, -flat.y() / cc, 1);
  }
};

/// The same lens as Marey has it, perhaps in a frame that is turned against OpenPTV's camera.
geometry::BrownFit lens_of(const PtvLens& lens, const PtvControl& control, const std::string& path) {
  const Vector<2> middle(control.size.width / 2.0 - 0.5, control.size.height / 2.0 - 0.5);
  geometry::BrownLens brown;
  brown.focal = lens.cc * lens.scale * control.pixel.cwiseInverse();
  brown.principal = middle + lens.scale * Vector<2>(lens.offset.x(), -lens.offset.y()).cwiseQuotient(control.pixel);
  const bool aside = lens.offset != Vector<2>::Zero() && lens.bends();
  if (!aside && lens.shear == 0) {
    const double c2 = lens.cc * lens.cc;
    brown.distortion = {lens.k[0] * c2, lens.k[1] * c2 * c2, -lens.p[1] * lens.cc, lens.p[0] * lens.cc, lens.k[2] * c2 * c2 * c2};
    return {.lens = brown};
  }
  const auto fit = geometry::fit_brown(
      [&](const Vector<2>& pixel) {
        const Vector<2> sensor = (pixel - middle).cwiseProduct(control.pixel);
        return lens.direction({sensor.x(), -sensor.y()});
      },
      control.size, brown, {.coefficients = 8, .turn = true});
  if (!fit || !(fit->rms_px <= kLensNearEnough)) {
    throw Error("{}: no Brown lens stands for its shear of {} rad and its distortion about a place beside the principal point{}",
                path, lens.shear, fit ? fmt::format(": the nearest is {:.2f} px off", fit->rms_px) : "");
  }
  return *fit;
}

/// `off_px`: the most that a lens of Brown is off OpenPTV's, RMS over the image.
RigCamera camera_of(const std::string& image, const PtvControl& control, double& off_px) {
  const std::string ori = image + ".ori", addpar = image + ".addpar";
  const std::vector<double> outside = ptv_numbers(ori, 18, "an OpenPTV orientation");
  PtvLens lens;
  lens.offset = {outside[15], outside[16]};
  lens.cc = outside[17];
  if (!(lens.cc > 0)) throw Error("{}: the camera constant is {} mm; it must be positive", ori, lens.cc);
  if (is_there(addpar)) {
    const std::vector<double> added = ptv_numbers(addpar, 7, "OpenPTV's additional parameters");
    lens.k = {added[0], added[1], added[2]};
    lens.p = {added[3], added[4]};
    lens.scale = added[5];
    lens.shear = added[6];
  }
  if (!(lens.scale > 0) || !(std::abs(lens.shear) < 1))
    throw Error("{}: a scale of {} and a shear of {} are not any", addpar, lens.scale, lens.shear);
  RigCamera camera;
  camera.name = fs::path(image).stem().string();
  camera.size = control.size;
  const geometry::BrownFit detected = lens_of(lens, control, ori);
  camera.lens = detected.lens;
  off_px = std::max(off_px, detected.rms_px);
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R(outside.data() + 6);
  const Vector<3> centre = kMillimetres * Vector<3>(outside[0], outside[1], outside[2]);
  const Matrix<3> rotation = detected.turn * Vector<3>(1, -1, -1).asDiagonal() * R.transpose();
  camera.camera_from_world = Rigid3{rotation, -rotation * centre};
  return camera;
}

/// The working folder's ptv.par for a path to the folder, the file itself, or one camera's orientation.
std::string control_path(const std::string& path) {
  const fs::path given(path);
  std::error_code error;
  if (fs::is_directory(given, error)) return (given / "parameters" / "ptv.par").string();
  if (given.filename() == "ptv.par") return path;
  for (const fs::path& folder :
       {given.parent_path() / ".." / "parameters", given.parent_path() / "parameters", given.parent_path()}) {
    if (is_there(folder / "ptv.par")) return (folder / "ptv.par").string();
  }
  throw Error(
      "{}: how large its images and pixels are says OpenPTV's parameters/ptv.par, which is neither beside it nor beside its "
      "folder",
      path);
}

Rig read_openptv_rig(const std::string& path) {
  const std::string control_file = control_path(path);
  const PtvControl control = control_of(control_file);
  Rig rig;
  double off_px = 0;
  if (fs::path(path).extension() == ".ori") {
    rig.cameras.push_back(camera_of(fs::path(path).replace_extension().string(), control, off_px));
  } else {
    const fs::path control_folder = fs::path(control_file).parent_path();
    const fs::path folder = control_folder.filename() == "parameters" ? control_folder / ".." : control_folder;
    for (const std::string& image : control.cameras)
      rig.cameras.push_back(camera_of((folder / image).lexically_normal().string(), control, off_px));
  }
  rig.calibration.emplace().method = off_px > 0 ? fmt::format("OpenPTV, lenses to {:.2g} px", off_px) : "OpenPTV";
  check_imported(rig, path);
  return rig;
}

bool is_openptv(const Beginning& file) {
  const fs::path path(file.path);
  if (file.folder) return is_there(path / "parameters" / "ptv.par");
  return file.is_text() && (path.filename() == "ptv.par" || path.extension() == ".ori");
}

}  // namespace

Format openptv_format() {
  return {.name = "openptv",
          .title = "OpenPTV's cameras",
          .endings = "",
          .holds = Content::rig,
          .detail = "mm; a working folder, its ptv.par, or one camera's .ori; not through glass and water",
          .is = is_openptv,
          .read_rig = read_openptv_rig};
}

}  // namespace marey::format::rig
