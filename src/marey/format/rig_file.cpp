// A rig file is read in one walk over its parsed tables. Each problem is noted with its line and the walk goes on, so that
// the user hears of all of them at once; only a text that is no TOML at all ends it early.
#include "marey/format/rig_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <set>
#include <span>
#include <utility>

#include <Eigen/SVD>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include "marey/core/error.h"
#include "marey/format/whole_file.h"

namespace marey {
namespace {

constexpr double kLargest = 1e9;         // of any number in the file
constexpr double kLargestPicture = 1e5;  // px, of either side
constexpr double kRotationSlack = 1e-3;  // what rounding to four digits leaves of RᵀR − I
constexpr double kRotationExact = 1e-9;  // above, the nearest rotation is taken

/// A text fit for a one-line message.
std::string shown(std::string_view text, std::size_t most = 40) {
  std::string result(text.substr(0, most));
  for (char& c : result) {
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = '?';
  }
  return text.size() > most ? result + "..." : result;
}

class Problems {
 public:
  explicit Problems(std::string file) : file_(std::move(file)) {}

  void add(const toml::source_region& where, std::string what) { found_.emplace_back(where.begin.line, std::move(what)); }

  void throw_if_any() {
    if (found_.empty()) return;
    std::stable_sort(found_.begin(), found_.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::string all;
    for (const auto& [line, what] : found_) {
      all += fmt::format("{}{}:{}: {}", all.empty() ? "" : "\n", file_, std::max<unsigned>(1, line), what);
    }
    throw Error(all);
  }

 private:
  std::string file_;
  std::vector<std::pair<toml::source_index, std::string>> found_;
};

/// One table of the file: hands out its values by name and notes those that are not what they must be.
class Section {
 public:
  /// `title` begins each message about this table: `camera "left"`.
  Section(const toml::table& table, std::string title, Problems& problems)
      : table_(table), title_(std::move(title)), problems_(problems) {}

  void rename(std::string title) { title_ = std::move(title); }
  bool has(std::string_view key) const { return table_.contains(key); }

  /// A problem with a value, or, where the key is missing, with the table.
  void problem(std::string_view key, std::string_view what) const {
    const toml::node* node = table_.get(key);
    problems_.add(node != nullptr ? node->source() : table_.source(), fmt::format("{}: {}", title_, what));
  }

  void only(std::initializer_list<std::string_view> known) const {
    for (const auto& [key, value] : table_) {
      if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
      problems_.add(key.source(),
                    fmt::format("{}: unknown key \"{}\"; there are: {}", title_, shown(key.str()), fmt::join(known, ", ")));
    }
  }

  std::optional<std::string> text(std::string_view key) const {
    const toml::node* node = table_.get(key);
    if (node == nullptr) return std::nullopt;
    if (const auto* value = node->as_string()) {
      if (value->get().find('\0') == std::string::npos) return value->get();
    }
    problem(key, fmt::format("{} must be a text in quotation marks", key));
    return std::nullopt;
  }

  std::optional<double> number(std::string_view key) const {
    const toml::node* node = table_.get(key);
    if (node == nullptr) return std::nullopt;
    if (const auto value = number_of(*node)) return value;
    problem(key, fmt::format("{} must be a finite number below 1e9", key));
    return std::nullopt;
  }

  std::optional<double> positive(std::string_view key) const {
    const auto value = number(key);
    if (!value || *value > 0) return value;
    problem(key, fmt::format("{} is {}; it must be positive", key, *value));
    return std::nullopt;
  }

  std::optional<int> count(std::string_view key) const {
    const auto value = number(key);
    if (!value) return std::nullopt;
    if (*value >= 0 && *value == std::floor(*value)) return static_cast<int>(*value);
    problem(key, fmt::format("{} is {}; it must be a count", key, *value));
    return std::nullopt;
  }

  /// Between `fewest` and `most` numbers.
  std::optional<std::vector<double>> numbers(std::string_view key, std::size_t fewest, std::size_t most,
                                             std::string_view form) const {
    const toml::node* node = table_.get(key);
    if (node == nullptr) return std::nullopt;
    if (auto values = numbers_of(*node); values && values->size() >= fewest && values->size() <= most) return values;
    problem(key, fmt::format("{} must be {}", key, form));
    return std::nullopt;
  }

  std::optional<Matrix<3>> matrix(std::string_view key) const {
    const toml::node* node = table_.get(key);
    if (node == nullptr) return std::nullopt;
    Matrix<3> result;
    const toml::array* rows = node->as_array();
    bool good = rows != nullptr && rows->size() == 3;
    for (std::size_t i = 0; good && i < 3; ++i) {
      const auto row = numbers_of(*rows->get(i));
      good = row && row->size() == 3;
      if (good) result.row(static_cast<int>(i)) = Eigen::Map<const Eigen::RowVector3d>(row->data());
    }
    if (good) return result;
    problem(key, fmt::format("{} must be three rows of three finite numbers", key));
    return std::nullopt;
  }

  std::optional<Matrix<3>> invertible(std::string_view key) const {
    const auto result = matrix(key);
    if (!result) return std::nullopt;
    // Rows and columns may differ much in size (px, m): what counts is the angle between scaled columns.
    Matrix<3> even = *result;
    for (int i = 0; i < 3; ++i) even.col(i) /= std::max(even.col(i).norm(), 1e-300);
    for (int i = 0; i < 3; ++i) even.row(i) /= std::max(even.row(i).norm(), 1e-300);
    if (std::abs(even.determinant()) > 1e-9) return result;
    problem(key, fmt::format("{} is singular; it must map the plane one to one", key));
    return std::nullopt;
  }

  /// A rotation matrix, made exact where it is rounded.
  std::optional<Matrix<3>> rotation(std::string_view key) const {
    const auto given = matrix(key);
    if (!given) return std::nullopt;
    const double off = (given->transpose() * *given - Matrix<3>::Identity()).cwiseAbs().maxCoeff();
    if (off > kRotationSlack) {
      problem(key,
              fmt::format("{} is no rotation: its rows must have length 1 and be perpendicular, and are off by {:.2g}", key, off));
    } else if (given->determinant() < 0) {
      problem(key, fmt::format("{} is a mirroring (its determinant is -1); it must be a rotation", key));
    } else if (off < kRotationExact) {
      return given;
    } else {
      const Eigen::JacobiSVD<Matrix<3>> svd(*given, Eigen::ComputeFullU | Eigen::ComputeFullV);
      return Matrix<3>(svd.matrixU() * svd.matrixV().transpose());
    }
    return std::nullopt;
  }

 private:
  static std::optional<double> number_of(const toml::node& node) {
    if (!node.is_integer() && !node.is_floating_point()) return std::nullopt;
    const double value = node.is_integer() ? static_cast<double>(node.as_integer()->get()) : node.as_floating_point()->get();
    if (!(std::abs(value) < kLargest)) return std::nullopt;
    return value;
  }

  static std::optional<std::vector<double>> numbers_of(const toml::node& node) {
    const toml::array* array = node.as_array();
    if (array == nullptr) return std::nullopt;
    std::vector<double> values;
    for (const toml::node& each : *array) {
      const auto value = number_of(each);
      if (!value) return std::nullopt;
      values.push_back(*value);
    }
    return values;
  }

  const toml::table& table_;
  std::string title_;
  Problems& problems_;
};

bool whole(double value) {
  return value == std::floor(value);
}

std::optional<cv::Size> read_size(const Section& section) {
  const auto size = section.numbers("size", 2, 2, "[width, height] in px");
  if (!size) return std::nullopt;
  for (const double side : *size) {
    if (side >= 1 && side <= kLargestPicture && whole(side)) continue;
    section.problem("size", fmt::format("size is [{}, {}]; both must be positive whole numbers of px", (*size)[0], (*size)[1]));
    return std::nullopt;
  }
  return cv::Size(static_cast<int>((*size)[0]), static_cast<int>((*size)[1]));
}

std::optional<cv::Rect> read_region(const Section& section) {
  const auto r = section.numbers("region", 4, 4, "[x, y, width, height] in px");
  if (!r) return std::nullopt;
  for (std::size_t i = 0; i < 4; ++i) {
    if (whole((*r)[i]) && (*r)[i] >= (i < 2 ? 0 : 1) && (*r)[i] <= kLargestPicture) continue;
    section.problem("region", fmt::format("region is [{}]; it must be whole px, the corner not negative and the sides positive",
                                          fmt::join(*r, ", ")));
    return std::nullopt;
  }
  return cv::Rect(static_cast<int>((*r)[0]), static_cast<int>((*r)[1]), static_cast<int>((*r)[2]), static_cast<int>((*r)[3]));
}

Lens blank_lens(const Section& section) {
  const auto model = section.text("model");
  if (!model || *model == BrownLens::name) return BrownLens{};
  if (*model == FisheyeLens::name) return FisheyeLens{};
  if (*model == TsaiLens::name) return TsaiLens{};
  section.problem("model", fmt::format("model \"{}\" is unknown; there are: brown, fisheye, tsai", shown(*model)));
  return BrownLens{};
}

std::optional<Lens> read_lens(const Section& section) {
  if (!section.has("focal") && !section.has("principal") && !section.has("distortion")) {
    blank_lens(section);  // a model alone says nothing, but must be one
    return std::nullopt;
  }
  Lens lens = blank_lens(section);
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
      [&](auto model) -> std::optional<Lens> {
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

/// Sources lie beside the rig file. What names a protocol ("rtsp://…") is no path.
std::string beside(const std::string& folder, const std::string& source) {
  if (folder.empty() || source.empty() || source.find("://") != std::string::npos) return source;
  return (std::filesystem::path(folder) / source).lexically_normal().string();
}

void check_name(const Section& section, const std::string& name) {
  if (name.empty()) section.problem("name", "its name is missing or empty; add name = \"…\"");
  if (std::any_of(name.begin(), name.end(), [](char c) {
        return static_cast<unsigned char>(c) < ' ' || c == '\x7f' || std::string_view("/\\,=\"").find(c) != std::string_view::npos;
      })) {
    section.problem("name", "its name may hold no / \\ , = \" and no control character: it names files and stands in tables");
  }
}

RigCamera read_camera(Section& section, int index, const std::string& folder) {
  RigCamera camera;
  camera.name = section.text("name").value_or("");
  section.rename(camera.name.empty() ? fmt::format("camera {}", index + 1) : fmt::format("camera \"{}\"", shown(camera.name)));
  section.only({"name", "source", "detections", "region", "rate", "offset_s", "size", "model", "focal", "principal", "distortion",
                "rotation", "translation", "ground_from_image", "rms_px"});
  check_name(section, camera.name);
  camera.source = beside(folder, section.text("source").value_or(""));
  camera.detections = beside(folder, section.text("detections").value_or(""));
  if (!camera.source.empty() && !camera.detections.empty()) {
    section.problem("detections", "it has both a source and detections; keep one of them");
  }
  camera.region = read_region(section);
  camera.rate_hz = section.positive("rate");
  camera.offset_s = section.number("offset_s").value_or(0);
  camera.size = read_size(section);
  if (camera.region && camera.size && camera.region->size() != *camera.size) {
    section.problem("size", fmt::format("size is {} x {} and its region is {} x {}; they must agree", camera.size->width,
                                        camera.size->height, camera.region->width, camera.region->height));
  }
  if (camera.region && !section.has("size")) camera.size = camera.region->size();
  camera.lens = read_lens(section);
  camera.camera_from_world = read_pose(section);
  camera.ground_from_image = section.invertible("ground_from_image");
  if (!camera.size && !section.has("size") && (camera.lens || camera.ground_from_image)) {
    section.problem("size",
                    "its size is missing; a calibration needs the size of the picture it holds for: add size = [width, height]");
  }
  camera.rms_px = section.number("rms_px");
  return camera;
}

/// World with y up from the world with z up.
Rigid3 y_up_from_z_up() {
  Rigid3 turn;
  turn.rotation << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  return turn;
}

/// Reads [world]; true where y is up.
bool read_world(const toml::node& node, Problems& problems, Rig& rig) {
  if (!node.is_table()) {
    problems.add(node.source(), "world must be a table: [world]");
    return false;
  }
  const Section section(*node.as_table(), "world", problems);
  section.only({"up", "ground_from_world"});
  rig.ground_from_world = section.invertible("ground_from_world");
  const std::string up = section.text("up").value_or("z");
  if (up != "y" && up != "z") section.problem("up", fmt::format("up is \"{}\"; it must be \"z\" or \"y\"", shown(up)));
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
  toml::table file;
  try {
    file = toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    throw Error("{}:{}: {}", name, std::max<unsigned>(1, error.source().begin.line), shown(error.description(), 200));
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
      problems.add(key.source(), fmt::format("unknown key \"{}\"; there are: world, calibration, camera", shown(key.str())));
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
  std::ifstream in(path, std::ios::binary);
  if (!in || std::filesystem::is_directory(path)) throw Error("{}: this rig file cannot be read; is the name right?", path);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return parse_rig(text, path, folder.empty() ? "." : folder);
}

}  // namespace marey
