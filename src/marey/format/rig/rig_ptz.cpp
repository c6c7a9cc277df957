#include "marey/format/rig/rig_ptz.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/files/whole_file.h"
#include "marey/format/nesting.h"
#include "marey/format/read_file.h"
#include "marey/format/rig/rig_file.h"
#include "marey/format/rig/rig_section.h"
#include "marey/format/text_rows.h"

namespace marey::format::rig {
namespace {

constexpr std::string_view kPtzHeader = "time,pan,tilt,focal,pan_sd,tilt_sd,focal_sd,pan_tilt,pan_focal,tilt_focal";
constexpr std::string_view kPositionHeader =
    ",position_pan_sd,position_tilt_sd,position_focal_sd,position_pan_tilt,position_pan_focal,position_tilt_focal";
constexpr std::size_t kPtzColumns = 10, kAllColumns = 16;
constexpr double kTurnDegree = std::numbers::pi / 180;
constexpr double kMaxDegrees = 1e4;

/// One row's numbers; nothing if one is missing or none.
std::optional<std::vector<double>> numbers_in_row(const std::vector<std::string_view>& fields, std::size_t columns) {
  std::vector<double> values;
  if (fields.size() != columns) return std::nullopt;
  for (const std::string_view& field : fields) {
    const auto value = number_of(field);
    if (!value) return std::nullopt;
    values.push_back(*value);
  }
  return values;
}

bool is_lost(const std::vector<std::string_view>& fields) {
  for (std::size_t i = 1; i < fields.size(); ++i) {
    if (!fields[i].empty()) return false;
  }
  return true;
}

/// From standard deviations (degrees, px) and correlations, six numbers from `first` on.
Matrix<3> covariance_in(const std::vector<double>& row, std::size_t first) {
  const Vector<3> sd(row[first] * kTurnDegree, row[first + 1] * kTurnDegree, row[first + 2] / row[3]);
  Matrix<3> together = Matrix<3>::Identity();
  together(0, 1) = together(1, 0) = row[first + 3];
  together(0, 2) = together(2, 0) = row[first + 4];
  together(1, 2) = together(2, 1) = row[first + 5];
  return sd.asDiagonal() * together * sd.asDiagonal();
}

PtzCamera::Turn turn_of(const std::vector<double>& row, cv::Size size) {
  PtzCamera::Turn turn;
  turn.time_s = row[0];
  turn.heading = geometry::Heading{row[1] * kTurnDegree, row[2] * kTurnDegree, std::log(row[3] / (size.width / 2.0))};
  turn.covariance = covariance_in(row, 4);
  if (row.size() == kAllColumns) turn.position_covariance = covariance_in(row, kPtzColumns);
  return turn;
}

bool in_domain(const std::vector<double>& row) {
  bool good = std::abs(row[1]) < kMaxDegrees && std::abs(row[2]) < kMaxDegrees && row[3] > 1 && row[3] < 1e7;
  for (std::size_t first = 4; first < row.size(); first += 6) {
    for (std::size_t i = first; i < first + 3; ++i) good = good && row[i] >= 0 && row[i] < 1e6;
    for (std::size_t i = first + 3; i < first + 6; ++i) good = good && std::abs(row[i]) <= 1;
  }
  return good;
}

/// Standard deviations and correlations, each with a comma before it.
void add_covariance(std::string& text, const Matrix<3>& covariance, double focal) {
  const Vector<3> sd = covariance.diagonal().cwiseMax(0).cwiseSqrt();
  const auto together = [&](int i, int k) {
    const double both = sd(i) * sd(k);
    return both > 0 ? std::clamp(covariance(i, k) / both, -1.0, 1.0) : 0.0;
  };
  fmt::format_to(std::back_inserter(text), ",{:.4g},{:.4g},{:.4g},{:.6f},{:.6f},{:.6f}", sd(0) / kTurnDegree, sd(1) / kTurnDegree,
                 sd(2) * focal, together(0, 1), together(0, 2), together(1, 2));
}

/// What a camera's table says of how it turns; nothing if it stands.
std::shared_ptr<const PtzCamera> ptz_in(const Section& section, const std::string& folder) {
  const auto file = section.text("ptz");
  if (!section.has("ptz")) {
    for (const char* key : {"pivot", "axis_tilt", "nodal_offset", "radial"}) {
      if (section.has(key)) section.problem(key, fmt::format("{} is of a PTZ camera: add ptz = \"FILE.csv\"", key));
    }
    return nullptr;
  }
  for (const char* key : {"focal", "rotation", "translation", "ground_from_image"}) {
    if (section.has(key))
      section.problem(key, fmt::format("{} is of a static camera, and this one is a PTZ camera; keep one of them", key));
  }
  if (!section.has("pivot")) section.problem("ptz", "a PTZ camera needs its place: add pivot = [x, y, z] in m");
  if (!section.has("size"))
    section.problem("ptz", "a PTZ camera needs the size its focal lengths are for: add size = [width, height]");
  const auto size = section.numbers("size", 2, 2, "[width, height] in px"),
             location = section.numbers("pivot", 3, 3, "[x, y, z] in m"),
             lean = section.numbers("axis_tilt", 3, 3, "[about x, about y, roll] in degrees");
  const auto ahead = section.number("nodal_offset"), bend = section.number("radial");
  if (!file || !location || !size) return nullptr;
  auto camera = std::make_shared<PtzCamera>();
  camera->tripod.location = {(*location)[0], (*location)[1], (*location)[2]};
  if (lean)
    camera->tripod.lean = {(*lean)[0] * kTurnDegree, (*lean)[1] * kTurnDegree}, camera->tripod.roll = (*lean)[2] * kTurnDegree;
  camera->tripod.ahead = ahead.value_or(0), camera->tripod.bend = bend.value_or(0);
  try {
    const std::string path = (std::filesystem::path(folder) / *file).string();
    camera->rotations = parse_ptz(read_file(path), path, cv::Size(static_cast<int>((*size)[0]), static_cast<int>((*size)[1])));
  } catch (const Error& error) {
    section.problem("ptz", error.what());
    return nullptr;
  }
  return camera;
}

/// The keys of a camera's table that specify its rotation.
std::string tripod_text(const geometry::Tripod& tripod, const std::string& rotations) {
  return fmt::format(
      "ptz = \"{}\"  # pan, tilt and focal length, a row per frame\n"
      "pivot = [{:.6f}, {:.6f}, {:.6f}]  # m: where the axes of pan and tilt meet\n"
      "axis_tilt = [{:.6f}, {:.6f}, {:.6f}]  # of the pan axis about x and y, and roll, in degrees\n"
      "nodal_offset = {:.6f}  # m from the axes to the centre of projection\n"
      "radial = {:.8f}  # distortion per half image width squared\n",
      rotations, tripod.location.x(), tripod.location.y(), tripod.location.z(), tripod.lean.x() / kTurnDegree,
      tripod.lean.y() / kTurnDegree, tripod.roll / kTurnDegree, tripod.ahead, tripod.bend);
}

}  // namespace

std::vector<PtzCamera::Turn> parse_ptz(std::string_view text, const std::string& name, cv::Size size) {
  std::vector<PtzCamera::Turn> rotations;
  TextLines lines(text);
  std::string_view line;
  std::vector<std::string_view> fields;
  const std::string with_positions = std::string(kPtzHeader) + std::string(kPositionHeader);
  const bool any = lines.next(line);
  if (!any || (line != kPtzHeader && line != with_positions)) throw Error("{}:1: its first line must read {}", name, kPtzHeader);
  const std::size_t columns = line == kPtzHeader ? kPtzColumns : kAllColumns;
  while (lines.next(line)) {
    if (line.empty()) continue;
    split_fields(line, ',', fields);
    PtzCamera::Turn turn;
    const auto time = number_of(fields[0]);
    if (!time) throw Error("{}:{}: a row begins with its frame's time in s", name, lines.number());
    turn.time_s = *time;
    if (!is_lost(fields)) {
      const auto row = numbers_in_row(fields, columns);
      if (!row || !in_domain(*row))
        throw Error(
            "{}:{}: {} is not a row of a PTZ file: time in s, pan and tilt in degrees, a positive focal length in px, three "
            "standard "
            "deviations, three correlations; or the time alone where the camera is lost",
            name, lines.number(), shown(line));
      turn = turn_of(*row, size);
    }
    if (!rotations.empty() && turn.time_s <= rotations.back().time_s)
      throw Error("{}:{}: its time {} s is not after that of the row before; rows go by time", name, lines.number(), turn.time_s);
    rotations.push_back(turn);
  }
  if (rotations.empty()) throw Error("{}: it has not one frame", name);
  return rotations;
}

std::string ptz_text(const PtzCamera& camera, cv::Size size) {
  const bool positions = std::any_of(camera.rotations.begin(), camera.rotations.end(),
                                     [](const PtzCamera::Turn& turn) { return turn.position_covariance.has_value(); });
  std::string text(kPtzHeader);
  if (positions) text += kPositionHeader;
  text += '\n';
  for (const PtzCamera::Turn& turn : camera.rotations) {
    fmt::format_to(std::back_inserter(text), "{:.6f}", turn.time_s);
    if (!turn.heading) {
      text.append((positions ? kAllColumns : kPtzColumns) - 1, ',');
    } else {
      const double focal = std::exp(turn.heading->log_focal) * size.width / 2;
      fmt::format_to(std::back_inserter(text), ",{:.5f},{:.5f},{:.3f}", turn.heading->pan / kTurnDegree,
                     turn.heading->tilt / kTurnDegree, focal);
      add_covariance(text, turn.covariance, focal);
      if (positions) add_covariance(text, turn.position_covariance.value_or(turn.covariance), focal);
    }
    text += '\n';
  }
  return text;
}

std::vector<std::shared_ptr<const PtzCamera>> read_ptz(const std::string& rig_path) {
  const std::string text = read_file(rig_path);
  check_nesting(text, Notation::toml, rig_path);
  toml::table file;
  try {
    file = toml::parse(text, rig_path);
  } catch (const toml::parse_error& error) {
    throw Error("{}:{}: {}", rig_path, std::max<unsigned>(1, error.source().begin.line), excerpt(error.description(), 200));
  }
  const std::string folder = std::filesystem::path(rig_path).parent_path().string();
  Problems problems(rig_path);
  std::vector<std::shared_ptr<const PtzCamera>> ptz;
  const toml::array* cameras = file["camera"].as_array();
  for (std::size_t i = 0; cameras != nullptr && i < cameras->size(); ++i) {
    if (const toml::table* table = cameras->get(i)->as_table())
      ptz.push_back(ptz_in(Section(*table, fmt::format("camera {}", i + 1), problems), folder));
  }
  problems.throw_if_any();
  return ptz;
}

void write_ptz_rig(const Rig& rig, const std::vector<std::shared_ptr<const PtzCamera>>& ptz, const std::string& path) {
  const std::filesystem::path location(path);
  std::string text;
  Rig camera_alone = rig;  // the text is the typical one, camera by camera, each followed by its tripod
  const std::string folder = location.parent_path().empty() ? "." : location.parent_path().string();
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    camera_alone.cameras = {rig.cameras[i]};
    const std::string one = rig_text(camera_alone, folder);
    text += i == 0 ? one : one.substr(one.find("\n[[camera]]"));
    if (i >= ptz.size() || !ptz[i]) continue;
    const std::string name = fmt::format("{}_{}_ptz.csv", location.stem().string(), rig.cameras[i].name);
    WholeFile rows((location.parent_path() / name).string());
    rows.write(ptz_text(*ptz[i], rig.cameras[i].size.value()));
    rows.finish();
    text += tripod_text(ptz[i]->tripod, name);
  }
  WholeFile file(path);
  file.write(text);
  file.finish();
}

}  // namespace marey::format::rig
