#include "marey/format/rig/rig_exchange.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <set>

#include <Eigen/LU>
#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/input_file.h"
#include "marey/core/text_safety.h"
#include "marey/format/rig/rig_file.h"
#include "marey/format/rig/self_cal_folder.h"
#include "marey/geometry/decompositions.h"
#include "marey/geometry/lens_fit.h"

namespace marey::format::rig {
namespace {

struct NamedFormat {
  std::string_view name;
  RigFormat format;
};
constexpr std::array<NamedFormat, 6> kFormats{{{"marey", RigFormat::marey},
                                               {"opencv", RigFormat::opencv},
                                               {"aniposelib", RigFormat::aniposelib},
                                               {"multicamselfcal", RigFormat::self_cal},
                                               {"qualisys", RigFormat::qualisys},
                                               {"tsai", RigFormat::tsai}}};

constexpr double kNearEnough = 0.05;  // px RMS, of a lens that stands for another

constexpr double kLargestInRig = 1e9;  // of any number in a rig

bool is_sound(double value) {
  return std::abs(value) < kLargestInRig;
}

bool has(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

/// A pixel's direction through a whole lens.
std::optional<Vector<3>> bearing(const geometry::Lens& lens, cv::Size size, const Vector<2>& pixel) {
  return Camera(lens, Rigid3{}, size).bearing(pixel);
}

/// A name that is fit for a rig: no / \ , = " and no control characters.
std::string fit_name(std::string name) {
  name = plain_text(name);
  for (char& c : name) {
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7f' || has("/\\,=\"", {&c, 1})) c = '_';
  }
  return name;
}

void check_rotation(Matrix<3>& rotation, const std::string& path, const std::string& name) {
  const double off = (rotation.transpose() * rotation - Matrix<3>::Identity()).cwiseAbs().maxCoeff();
  if (!(off < 1e-2))
    throw Error("{}: camera \"{}\": its rotation is none: rows must have length 1 and be perpendicular", path, name);
  if (rotation.determinant() < 0) throw Error("{}: camera \"{}\": its rotation is a mirroring (determinant -1)", path, name);
  if (off < 1e-9) return;
  const geometry::SingularValues3 svd = geometry::singular_values(rotation);
  rotation = svd.U * svd.V.transpose();
}

}  // namespace

std::string rig_format_names() {
  std::string names;
  for (const NamedFormat& each : kFormats) names.append(names.empty() ? "" : ", ").append(each.name);
  return names;
}

RigFormat parse_rig_format(std::string_view name) {
  for (const NamedFormat& each : kFormats) {
    if (each.name == name) return each.format;
  }
  throw Error("\"{}\" is no format of calibrations; these are: {}", name, rig_format_names());
}

std::optional<RigFormat> rig_format_of_content(const std::string& path) {
  if (std::filesystem::is_directory(path)) return SelfCalFolder::is_one(path) ? std::optional(RigFormat::self_cal) : std::nullopt;
  InputStream in(path);
  std::string text(1 << 16, '\0');
  in.read(text.data(), std::ssize(text));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.find('\0') != std::string::npos) return std::nullopt;  // a take holds a rig's text among other things
  if (has(text, "<opencv_storage") || text.starts_with("%YAML") || text.starts_with("---")) return RigFormat::opencv;
  const bool xml = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF") == text.find('<') && has(text, "<");
  if (xml && has(text, "<calibration") && has(text, "<camera")) return RigFormat::qualisys;
  if (xml && has(text, "<Camera") && has(text, "<Geometry")) return RigFormat::tsai;
  if (xml) return std::nullopt;
  if (has(text, "[[camera]]") || has(text, "[world]")) return RigFormat::marey;
  if (has(text, "matrix") && (has(text, "[cam") || has(text, "distortions"))) return RigFormat::aniposelib;
  if (path.ends_with(".toml")) return RigFormat::marey;
  if (path.ends_with(".yml") || path.ends_with(".yaml") || (path.ends_with(".json") && has(text, "matrix")))
    return RigFormat::opencv;
  return std::nullopt;
}

std::optional<RigFormat> rig_format_of_name(std::string_view path) {
  constexpr std::array<std::pair<std::string_view, RigFormat>, 7> kEndings{{{".toml", RigFormat::marey},
                                                                            {".yml", RigFormat::opencv},
                                                                            {".yaml", RigFormat::opencv},
                                                                            {".json", RigFormat::opencv},
                                                                            {".qca.txt", RigFormat::qualisys},
                                                                            {".xml", RigFormat::tsai},
                                                                            {"/", RigFormat::self_cal}}};
  for (const auto& [ending, format] : kEndings) {
    if (path.ends_with(ending)) return format;
  }
  return std::nullopt;
}

Rig read_rig_any(const std::string& path) {
  if (!std::filesystem::exists(path)) throw Error("{}: there is no such file; is the name right?", path);
  const auto format = rig_format_of_content(path);
  if (!format) throw Error("{}: this is no calibration that is known; these are: {}", path, rig_format_names());
  switch (*format) {
    case RigFormat::marey:
      return read_rig(path);
    case RigFormat::opencv:
      return read_opencv_rig(path);
    case RigFormat::aniposelib:
      return read_aniposelib_rig(path);
    case RigFormat::self_cal:
      return read_self_cal_rig(path);
    case RigFormat::qualisys:
      return read_qualisys_rig(path);
    case RigFormat::tsai:
      return read_tsai_rig(path);
  }
  return {};
}

void write_rig_as(const Rig& rig, const std::string& path, RigFormat format) {
  switch (format) {
    case RigFormat::marey:
      return write_rig(rig, path);
    case RigFormat::opencv:
      return write_opencv_rig(rig, path);
    case RigFormat::aniposelib:
      return write_aniposelib_rig(rig, path);
    case RigFormat::self_cal:
      return write_self_cal_rig(rig, path);
    case RigFormat::qualisys:
      return write_qualisys_rig(rig, path);
    case RigFormat::tsai:
      return write_tsai_rig(rig, path);
  }
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
      throw Error("{}: camera \"{}\": its picture of {} x {} px is none", path, camera.name, camera.size->width,
                  camera.size->height);
    }
    if (camera.lens) {
      const double focal = geometry::focal_of(*camera.lens).minCoeff();
      if (!(focal > 0) || !(geometry::focal_of(*camera.lens).maxCoeff() < 1e9)) {
        throw Error("{}: camera \"{}\": focal length is {}; it must be positive", path, camera.name, focal);
      }
      const bool sound =
          (geometry::principal_of(*camera.lens).array().abs() < kLargestInRig).all() &&
          std::visit([](const auto& lens) { return std::all_of(lens.distortion.begin(), lens.distortion.end(), is_sound); },
                     *camera.lens);
      if (!sound) throw Error("{}: camera \"{}\": its lens has numbers that are not finite, or beyond 1e9", path, camera.name);
    }
    if (camera.rms_px && !is_sound(*camera.rms_px)) camera.rms_px.reset();
    if (!camera.camera_from_world) continue;
    check_rotation(camera.camera_from_world->rotation, path, camera.name);
    if (!(camera.camera_from_world->translation.array().abs() < kLargestInRig).all())
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
