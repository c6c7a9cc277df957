// A rig file is read in one walk over its parsed tables. Each problem is noted with its line and the walk continues, so that
// the user receives of all of them at once; only a text that is not a TOML at all ends it early.
#include "marey/format/rig/rig_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include "marey/core/error.h"
#include "marey/files/source_name.h"
#include "marey/format/nesting.h"
#include "marey/format/read_file.h"
#include "marey/format/rig/imported_rig.h"
#include "marey/format/rig/rig_section.h"

namespace marey::format::rig {
namespace {

constexpr double kMaxImage = 1e5;                    // px, of either side
constexpr std::size_t kMaxMasks = 256;               // of a camera
constexpr double kMinGround = 10, kMaxGround = 500;  // m, from the middle to its lines

bool whole(double value) {
  return value == std::floor(value);
}

/// Nothing if these are not whole px, or no part of an image.
std::optional<Mask> mask_of(std::span<const double> numbers) {
  std::vector<int> px;
  for (const double each : numbers) {
    if (!whole(each) || std::abs(each) > kMaxImage) return std::nullopt;
    px.push_back(static_cast<int>(each));
  }
  return Mask::of_numbers(px);
}

std::optional<cv::Size> read_size(const Section& section) {
  const auto size = section.numbers("size", 2, 2, "[width, height] in px");
  if (!size) return std::nullopt;
  for (const double side : *size) {
    if (side >= 1 && side <= kMaxImage && whole(side)) continue;
    section.problem("size", fmt::format("size is [{}, {}]; both must be positive whole numbers of px", (*size)[0], (*size)[1]));
    return std::nullopt;
  }
  return cv::Size(static_cast<int>((*size)[0]), static_cast<int>((*size)[1]));
}

std::optional<cv::Rect> read_region(const Section& section) {
  const auto r = section.numbers("region", 4, 4, "[x, y, width, height] in px");
  if (!r) return std::nullopt;
  const auto part = mask_of(*r);
  if (!part) {
    section.problem("region", fmt::format("region is [{}]; it must be whole px, the corner not negative and the sides positive",
                                          fmt::join(*r, ", ")));
    return std::nullopt;
  }
  return part->box();
}

std::vector<Mask> read_masks(const Section& section) {
  constexpr std::string_view kForm = "[[x, y, width, height], …] in px, a polygon its corners [x, y, x, y, x, y, …]";
  std::vector<Mask> masks;
  for (const std::vector<double>& row : section.rows("masks", 4, kMaxMasks, kForm)) {
    if (const auto mask = mask_of(row)) {
      masks.push_back(*mask);
    } else {
      section.problem("masks", fmt::format("masks is [{}]; it must be whole px, the corner not negative and the sides positive, or "
                                           "3 to {} corners of a polygon",
                                           fmt::join(row, ", "), Mask::kMaxCorners));
    }
  }
  return masks;
}

std::optional<double> read_not_negative(const Section& section, std::string_view key) {
  const auto value = section.number(key);
  if (!value || *value >= 0) return value;
  section.problem(key, fmt::format("{} is {}; it must not be negative", key, *value));
  return std::nullopt;
}

geometry::Lens blank_lens(const Section& section) {
  const auto model = section.text("model");
  if (!model) return geometry::BrownLens{};
  if (const auto lens = geometry::lens_named(*model)) return *lens;
  section.problem("model",
                  fmt::format("model \"{}\" is unknown; there are: {}", excerpt(*model), fmt::join(geometry::lens_names(), ", ")));
  return geometry::BrownLens{};
}

std::optional<geometry::Lens> read_lens(const Section& section) {
  if (!section.has("focal") && !section.has("principal") && !section.has("distortion")) {
    blank_lens(section);  // a model alone says nothing, but must be one
    return std::nullopt;
  }
  geometry::Lens lens = blank_lens(section);
  const auto focal = section.numbers("focal", 2, 2, "[fx, fy] in px");
  const auto principal = section.numbers("principal", 2, 2, "[cx, cy] in px");
  if (!section.has("focal")) section.problem("focal", "a lens is given without its focal length; add focal = [fx, fy] in px");
  if (!section.has("principal"))
    section.problem("principal", "a lens is given without its principal point; add principal = [cx, cy] in px");
  for (const double f : focal.value_or(std::vector<double>{})) {
    if (f > 0) continue;
    section.problem("focal", fmt::format("focal length is {}; it must be positive", f));
    return std::nullopt;
  }
  return std::visit(
      [&](auto model) -> std::optional<geometry::Lens> {
        const auto k =
            section.numbers("distortion", 0, model.distortion.size(),
                            fmt::format("at most {} finite numbers for the model \"{}\"", model.distortion.size(), model.name));
        if (!focal || !principal || (section.has("distortion") && !k)) return std::nullopt;
        model.focal = {(*focal)[0], (*focal)[1]};
        model.principal = {(*principal)[0], (*principal)[1]};
        if (k) std::copy(k->begin(), k->end(), model.distortion.begin());
        return model;
      },
      lens);
}

std::optional<Rigid3> read_pose(const Section& section) {
  const auto rotation = section.rotation("rotation");
  const auto translation = section.numbers("translation", 3, 3, "[x, y, z] in m");
  if (section.has("rotation") != section.has("translation")) {
    section.problem(section.has("rotation") ? "rotation" : "translation",
                    fmt::format("{0} is missing: a pose is rotation and translation together",
                                section.has("rotation") ? "translation" : "rotation"));
  }
  if (!rotation || !translation) return std::nullopt;
  return Rigid3{*rotation, {(*translation)[0], (*translation)[1], (*translation)[2]}};
}

void check_name(const Section& section, const std::string& name) {
  if (name.empty()) section.problem("name", "its name is missing or empty; add name = \"…\"");
  if (std::any_of(name.begin(), name.end(), unfit_for_camera_name))
    section.problem("name", "its name may hold no / \\ , = \" and no control character: it names files and stands in tables");
}

RigCamera read_camera(Section& section, int index, const std::string& folder) {
  RigCamera camera;
  camera.name = section.text("name").value_or("");
  section.rename(camera.name.empty() ? fmt::format("camera {}", index + 1) : fmt::format("camera \"{}\"", excerpt(camera.name)));
  section.only({"name",   "source", "detections", "region",     "rate",         "offset_s",    "size",
                "model",  "focal",  "principal",  "distortion", "rotation",     "translation", "ground_from_image",
                "rms_px", "ptz",    "pivot",      "axis_tilt",  "nodal_offset", "radial",      "exposure",
                "gain",   "masks",  "threshold"});
  check_name(section, camera.name);
  camera.source = source_in_folder(folder, section.text("source").value_or(""));
  camera.detections = source_in_folder(folder, section.text("detections").value_or(""));
  if (!camera.source.empty() && !camera.detections.empty()) {
    section.problem("detections", "it has both a source and detections; keep one of them");
  }
  camera.region = read_region(section);
  camera.rate_hz = section.positive("rate");
  camera.offset_s = section.number("offset_s");
  camera.size = read_size(section);
  if (camera.region && camera.size && camera.region->size() != *camera.size) {
    section.problem("size", fmt::format("size is {} x {} and its region is {} x {}; they must agree", camera.size->width,
                                        camera.size->height, camera.region->width, camera.region->height));
  }
  if (camera.region && !section.has("size")) camera.size = camera.region->size();
  camera.lens = read_lens(section);
  camera.camera_from_world = read_pose(section);
  camera.ground_from_image = section.invertible("ground_from_image");
  camera.rms_px = section.number("rms_px");
  camera.exposure_ms = section.positive("exposure");
  camera.gain = read_not_negative(section, "gain");
  camera.threshold = read_not_negative(section, "threshold");
  camera.masks = read_masks(section);
  return camera;
}

/// World with y up from the world with z up.
Rigid3 y_up_from_z_up() {
  Rigid3 turn;
  turn.rotation << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  return turn;
}

std::optional<Vector<2>> read_pair(const Section& section, std::string_view key) {
  const auto pair = section.numbers(key, 2, 2, "[x, y] in m");
  if (!section.has(key)) section.problem(key, fmt::format("{} is missing; add {} = [x, y] in m", key, key));
  if (!pair) return std::nullopt;
  return Vector<2>((*pair)[0], (*pair)[1]);
}

/// [world.ground]: level where anything is wrong with it.
geometry::GroundSurface read_ground(const toml::node& node, Problems& problems) {
  geometry::GroundSurface ground;
  if (!node.is_table()) {
    problems.add(node.source(), "ground must be a table: [world.ground]");
    return ground;
  }
  const Section section(*node.as_table(), "ground", problems);
  section.only({"centre", "half_size", "crown_across", "crown_along", "crown_dome", "ridge"});
  const auto centre = read_pair(section, "centre"), half = read_pair(section, "half_size");
  if (half && !(half->minCoeff() >= kMinGround && half->maxCoeff() <= kMaxGround)) {
    section.problem("half_size", fmt::format("half_size is [{}, {}]; from the centre to the lines it must be {} to {} m", half->x(),
                                             half->y(), kMinGround, kMaxGround));
    return {};
  }
  const auto height = [&](std::string_view key) {
    const double value = section.number(key).value_or(0);
    if (std::abs(value) <= geometry::GroundSurface::kMaxLevel) return value;
    section.problem(key,
                    fmt::format("{} is {} m; a pitch is raised by at most {} m", key, value, geometry::GroundSurface::kMaxLevel));
    return 0.0;
  };
  ground.across = height("crown_across"), ground.along = height("crown_along"), ground.dome = height("crown_dome");
  ground.ridge = section.number("ridge").value_or(0);
  if (!(ground.ridge >= 0 && ground.ridge <= 1)) {
    section.problem("ridge", fmt::format("ridge is {}; it must be between 0, a parabola, and 1, a roof", ground.ridge));
    return {};
  }
  if (centre) ground.middle = *centre;
  if (half) ground.half = *half;
  return ground;
}

/// Reads [world]; true where y is up.
bool read_world(const toml::node& node, Problems& problems, Rig& rig) {
  if (!node.is_table()) {
    problems.add(node.source(), "world must be a table: [world]");
    return false;
  }
  const Section section(*node.as_table(), "world", problems);
  section.only({"up", "ground_from_world", "ground"});
  rig.ground_from_world = section.invertible("ground_from_world");
  if (const toml::node* ground = node.as_table()->get("ground")) rig.ground = read_ground(*ground, problems);
  const std::string up = section.text("up").value_or("z");
  if (up != "y" && up != "z") section.problem("up", fmt::format("up is \"{}\"; it must be \"z\" or \"y\"", excerpt(up)));
  return up == "y";
}

Rig::Calibration read_calibration(const toml::node& node, Problems& problems) {
  Rig::Calibration calibration;
  if (!node.is_table()) {
    problems.add(node.source(), "calibration must be a table: [calibration]");
    return calibration;
  }
  const Section section(*node.as_table(), "calibration", problems);
  section.only({"method", "mean_px", "rms_px", "inliers", "observations", "grade"});
  calibration.method = section.text("method").value_or("");
  calibration.mean_px = section.number("mean_px");
  calibration.rms_px = section.number("rms_px");
  calibration.inliers = section.count("inliers");
  calibration.observations = section.count("observations");
  calibration.grade = section.text("grade");
  return calibration;
}

void read_cameras(const toml::node& node, const std::string& folder, Problems& problems, Rig& rig) {
  const toml::array* tables = node.as_array();
  if (tables == nullptr) return problems.add(node.source(), "camera must be written [[camera]], once for each camera");
  std::set<std::string> names;
  for (const toml::node& each : *tables) {
    if (!each.is_table()) {
      problems.add(each.source(), "camera must be written [[camera]], once for each camera");
      continue;
    }
    Section section(*each.as_table(), "camera", problems);
    RigCamera camera = read_camera(section, static_cast<int>(rig.cameras.size()), folder);
    if (!camera.name.empty() && !names.insert(camera.name).second) {
      section.problem("name", "another camera has this name; each needs its own");
    }
    rig.cameras.push_back(std::move(camera));
  }
}

}  // namespace

Rig parse_rig(std::string_view text, const std::string& name, const std::string& folder) {
  if (is_binary(text))
    throw Error("{}: is a binary file, as videos are; a rig file is wanted here, and a camera's video is given as CAMERA={}", name,
                name);
  check_nesting(text, Notation::toml, name);
  toml::table file;
  try {
    file = toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    throw Error("{}:{}: {}", name, std::max<unsigned>(1, error.source().begin.line), excerpt(error.description(), 200));
  }
  Problems problems(name);
  Rig rig;
  bool y_up = false;
  for (const auto& [key, value] : file) {
    if (key == "world") {
      y_up = read_world(value, problems, rig);
    } else if (key == "calibration") {
      rig.calibration = read_calibration(value, problems);
    } else if (key == "camera") {
      read_cameras(value, folder, problems, rig);
    } else {
      problems.add(key.source(), fmt::format("unknown key \"{}\"; there are: world, calibration, camera", excerpt(key.str())));
    }
  }
  if (!file.contains("camera")) problems.add({}, "there is no camera; add a [[camera]] for each");
  problems.throw_if_any();
  if (y_up) {
    for (RigCamera& camera : rig.cameras) {
      if (camera.camera_from_world) *camera.camera_from_world = *camera.camera_from_world * y_up_from_z_up();
    }
  }
  return rig;
}

Rig read_rig(const std::string& path) {
  const std::string text = read_file(path);
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return parse_rig(text, path, folder.empty() ? "." : folder);
}

Format marey_format() {
  return {.name = "marey",
          .title = "a rig",
          .endings = ".toml",
          .holds = Content::rig,
          .detail = "m, z up; everything: see [the rig](rig.md)",
          .is =
              [](const Beginning& file) {
                if (!file.is_text() || rig::is_xml(file)) return false;
                if (file.has("[[camera]]") || file.has("[world]")) return true;
                const bool aniposelib = file.has("matrix") && (file.has("[cam") || file.has("distortions"));
                return file.path.ends_with(".toml") && !aniposelib;
              },
          .read_rig = rig::read_rig,
          .write_rig = rig::write_rig};
}

}  // namespace marey::format::rig
