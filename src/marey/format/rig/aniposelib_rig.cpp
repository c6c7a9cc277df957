// Cameras as aniposelib and Caliscope keep them: a table for each ([cam_0] or [cameras.0]) with OpenCV's matrix and distortions,
// camera_from_world as Rodrigues' vector or matrix, and a translation whose unit is that of the board it was calibrated with. The
// unit is not in the file: where some camera is more than 100 units from the origin they are taken for millimetres, else for
// metres.
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include "marey/core/error.h"
#include "marey/files/text_safety.h"
#include "marey/files/whole_file.h"
#include "marey/format/nesting.h"
#include "marey/format/read_file.h"
#include "marey/format/rig/imported_rig.h"
#include "marey/format/rig/rig_section.h"

namespace marey::format::rig {
namespace {

constexpr double kMaxDistanceMetres = 100;

/// One camera's table.
class Table {
 public:
  Table(const toml::table& table, std::string path, std::string name)
      : table_(table), path_(std::move(path)), name_(plain_text(name)) {}

  bool has(std::string_view key) const {
    const toml::node* node = table_.get(key);
    return node != nullptr && !(node->is_array() && node->as_array()->empty()) && !node->is_string();
  }

  /// All numbers at `key`, rows of a matrix one after the other.
  std::vector<double> numbers(std::string_view key) const {
    std::vector<double> values;
    const toml::node* node = table_.get(key);
    if (node == nullptr) fail(key, "missing");
    collect(*node, key, values);
    return values;
  }

  std::vector<double> numbers(std::string_view key, std::size_t count) const {
    auto values = numbers(key);
    if (values.size() != count) fail(key, fmt::format("{} numbers; there must be {}", values.size(), count));
    return values;
  }

  bool flag(std::string_view key) const { return table_[key].value_or(false); }
  std::optional<std::string> text(std::string_view key) const { return table_[key].value<std::string>(); }
  std::optional<double> number(std::string_view key) const { return table_[key].value<double>(); }
  [[noreturn]] void fail(std::string_view key, std::string_view what) const {
    const toml::node* node = table_.get(key);
    const auto line = node != nullptr ? node->source().begin.line : table_.source().begin.line;
    throw Error("{}:{}: camera \"{}\": {} is {}", path_, std::max<unsigned>(1, line), name_, key, what);
  }

 private:
  void collect(const toml::node& node, std::string_view key, std::vector<double>& values) const {
    if (const toml::array* array = node.as_array()) {
      for (const toml::node& each : *array) collect(each, key, values);
    } else if (const auto value = node.value<double>(); value && std::isfinite(*value)) {
      values.push_back(*value);
    } else {
      fail(key, "not all finite numbers");
    }
  }

  const toml::table& table_;
  std::string path_, name_;
};

geometry::Lens lens_of(const Table& table) {
  const auto K = table.numbers("matrix", 9);
  auto k = table.has("distortions") ? table.numbers("distortions") : std::vector<double>{};
  while (!k.empty() && k.back() == 0) k.pop_back();
  const auto filled = [&](auto lens) -> geometry::Lens {
    if (k.size() > lens.distortion.size()) table.fail("distortions", fmt::format("too long for the model {}", lens.name));
    lens.focal = {K[0], K[4]};
    lens.principal = {K[2], K[5]};
    std::copy(k.begin(), k.end(), lens.distortion.begin());
    return lens;
  };
  return table.flag("fisheye") ? filled(geometry::FisheyeLens{}) : filled(geometry::BrownLens{});
}

RigCamera camera_of(const toml::table& toml, const std::string& path, const std::string& name) {
  const Table table(toml, path, name);
  RigCamera camera;
  camera.name = table.text("name").value_or(name);
  if (table.has("size")) {
    const auto size = table.numbers("size", 2);
    camera.size = cv::Size(cv::saturate_cast<int>(size[0]), cv::saturate_cast<int>(size[1]));
  }
  if (table.has("matrix")) camera.lens = lens_of(table);
  if (table.has("rotation") && table.has("translation")) {
    const auto R = table.numbers("rotation");
    const auto t = table.numbers("translation", 3);
    Rigid3 pose;
    if (R.size() == 3) {
      pose.rotation = geometry::rotation_from({R[0], R[1], R[2]});
    } else if (R.size() == 9) {
      pose.rotation = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(R.data());
    } else {
      table.fail("rotation", "neither a vector of three numbers nor a matrix of nine");
    }
    pose.translation = {t[0], t[1], t[2]};
    camera.camera_from_world = pose;
  }
  camera.rms_px = table.number("error");
  return camera;
}

/// [cameras.0] gives "cam0"; [cam_0] keeps its own name where it says no other.
void add_tables(const toml::table& table, const std::string& path, const std::string& prefix, Rig& rig) {
  for (const auto& [key, value] : table) {
    const toml::table* each = value.as_table();
    if (each == nullptr) continue;
    const std::string name = prefix + std::string(key.str());
    if (each->contains("matrix") || each->contains("size")) {
      if (!(*each)["ignore"].value_or(false)) rig.cameras.push_back(camera_of(*each, path, name));
    } else if (key.str() == "cameras") {
      add_tables(*each, path, "cam", rig);
    }
  }
}

void to_metres(Rig& rig) {
  double farthest = 0;
  for (const RigCamera& camera : rig.cameras) {
    if (camera.camera_from_world) farthest = std::max(farthest, camera.camera_from_world->translation.norm());
  }
  if (farthest <= kMaxDistanceMetres) return;
  for (RigCamera& camera : rig.cameras) {
    if (camera.camera_from_world) camera.camera_from_world->translation /= 1000;
  }
}

std::string list(std::initializer_list<double> values) {
  std::string text;
  for (const double value : values) text += fmt::format("{}{:.17g}", text.empty() ? "" : ", ", value);
  // TOML's arrays of older readers hold one type: no number may be written as an integer.
  std::string result;
  std::size_t at = 0;
  while (at <= text.size()) {
    std::string part = text.substr(at, text.find(", ", at) - at);
    at += part.size() + 2;
    if (part.find_first_of(".en") == std::string::npos) part += ".0";
    result += (result.empty() ? "" : ", ") + part;
  }
  return "[ " + result + ",]";
}

std::string camera_text(const RigCamera& camera, std::size_t index) {
  std::string text = fmt::format("[cam_{}]\nname = \"{}\"\n", index, camera.name);
  const bool fisheye = camera.lens && std::holds_alternative<geometry::FisheyeLens>(*camera.lens);
  if (!camera.size || !camera.lens || !camera.camera_from_world) {
    throw Error("camera \"{}\": its lens, size or pose is missing, which aniposelib needs; calibrate it first", camera.name);
  }
  text += fmt::format("size = [ {}, {},]\n", camera.size->width, camera.size->height);
  const geometry::Lens lens = fisheye ? *camera.lens : geometry::Lens(as_brown(camera, 5, "aniposelib"));
  const Vector<2>&focal = geometry::focal_of(lens), &principal = geometry::principal_of(lens);
  text += fmt::format("matrix = [ {}, {}, {},]\n", list({focal.x(), 0, principal.x()}), list({0, focal.y(), principal.y()}),
                      list({0, 0, 1}));
  if (const auto* model = std::get_if<geometry::FisheyeLens>(&lens)) {
    const auto& k = model->distortion;
    text += fmt::format("distortions = {}\n", list({k[0], k[1], k[2], k[3]}));
  } else {
    const auto& k = std::get<geometry::BrownLens>(lens).distortion;
    text += fmt::format("distortions = {}\n", list({k[0], k[1], k[2], k[3], k[4]}));
  }
  const Vector<3> r = geometry::angle_axis_of(camera.camera_from_world->rotation), &t = camera.camera_from_world->translation;
  text += fmt::format("rotation = {}\ntranslation = {}\n", list({r.x(), r.y(), r.z()}), list({t.x(), t.y(), t.z()}));
  if (fisheye) text += "fisheye = true\n";
  return text + "\n";
}

}  // namespace

Rig parse_aniposelib_rig(std::string_view text, const std::string& path) {
  check_nesting(text, Notation::toml, path);
  Rig rig;
  try {
    const toml::table file = toml::parse(text, path);
    add_tables(file, path, "", rig);
  } catch (const toml::parse_error& error) {
    throw Error("{}:{}: {}", path, std::max<unsigned>(1, error.source().begin.line), excerpt(error.description(), 200));
  }
  to_metres(rig);
  check_imported(rig, path);
  return rig;
}

Rig read_aniposelib_rig(const std::string& path) {
  return parse_aniposelib_rig(read_file(path), path);
}

void write_aniposelib_rig(const Rig& rig, const std::string& path) {
  std::string text;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) text += camera_text(rig.cameras[i], i);
  text += "[metadata]\nadjusted = true\n";
  if (rig.calibration && rig.calibration->rms_px) text += fmt::format("error = {:.6f}\n", *rig.calibration->rms_px);
  WholeFile file(path);
  file.write(text);
  file.finish();
}

Format aniposelib_format() {
  return {.name = "aniposelib",
          .title = "a calibration of aniposelib or Caliscope",
          .endings = {},
          .holds = Content::rig,
          .detail = "TOML of aniposelib and Caliscope; its unit is not said in it: see [the rig](rig.md)",
          .is =
              [](const Beginning& file) {
                return file.is_text() && !rig::is_xml(file) && file.has("matrix") && (file.has("[cam") || file.has("distortions"));
              },
          .read_rig = rig::read_aniposelib_rig,
          .write_rig = rig::write_aniposelib_rig};
}

}  // namespace marey::format::rig
