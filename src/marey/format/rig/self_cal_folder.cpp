#include "marey/format/rig/self_cal_folder.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/format/text_rows.h"

namespace marey::format::rig {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxCameras = 1000;

std::ifstream opened(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in || fs::is_directory(path)) throw Error("{}: the file cannot be read", path);
  return in;
}

std::vector<double> numbers_of(std::string_view line, const std::string& path, int number) {
  std::vector<double> values;
  const char* at = line.data();
  const char* const end = at + line.size();
  for (;;) {
    while (at != end && std::string_view(" \t\r,;").find(*at) != std::string_view::npos) ++at;
    if (at == end) return values;
    if (*at == '+') ++at;
    double value = 0;
    const auto [stop, failed] = std::from_chars(at, end, value);
    if (failed != std::errc()) throw Error("{}:{}: {} is no number", path, number, format::shown({at, end}));
    values.push_back(value);
    at = stop;
  }
}

/// Ranks of rows that name the same point in space, so that every camera's own order is kept. Rows of one camera follow each other
/// in time; a rank is free once all rows before it, in every camera, have theirs.
using SpacePoint = std::array<double, 4>;  // and how often it came before in this camera
std::map<SpacePoint, std::int64_t> ranks(const std::vector<std::vector<SpacePoint>>& by_camera) {
  std::map<SpacePoint, std::set<SpacePoint>> after;
  std::map<SpacePoint, int> waits_for;
  std::map<SpacePoint, std::pair<std::size_t, std::size_t>> first_seen;  // row, camera: the order where cameras do not specify
  for (std::size_t camera = 0; camera < by_camera.size(); ++camera) {
    const auto& rows = by_camera[camera];
    for (std::size_t i = 0; i < rows.size(); ++i) {
      waits_for.try_emplace(rows[i], 0);
      first_seen.try_emplace(rows[i], i, camera);
      if (i > 0 && after[rows[i - 1]].insert(rows[i]).second) ++waits_for[rows[i]];
    }
  }
  std::set<std::pair<std::pair<std::size_t, std::size_t>, SpacePoint>> free;
  for (const auto& [point, count] : waits_for) {
    if (count == 0) free.emplace(first_seen[point], point);
  }
  std::map<SpacePoint, std::int64_t> result;
  while (!free.empty()) {
    const SpacePoint point = free.begin()->second;
    free.erase(free.begin());
    result.emplace(point, std::ssize(result));
    for (const SpacePoint& next : after[point]) {
      if (--waits_for[next] == 0) free.emplace(first_seen[next], next);
    }
  }
  // Cameras that contradict each other about the order leave a circle: those go last.
  for (const auto& [point, detected] : first_seen) result.emplace(point, std::ssize(result));
  return result;
}

}  // namespace

Eigen::MatrixXd read_number_table(const std::string& path) {
  std::ifstream in = opened(path);
  std::vector<std::vector<double>> rows;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    const auto first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos || line[first] == '#' || line[first] == '%') continue;
    rows.push_back(numbers_of(line, path, number));
    if (rows.back().size() != rows.front().size()) {
      throw Error("{}:{}: this row has {} numbers and those above have {}; is the file cut off?", path, number, rows.back().size(),
                  rows.front().size());
    }
  }
  if (rows.empty()) throw Error("{}: there are no numbers in it", path);
  Eigen::MatrixXd table(rows.size(), rows.front().size());
  for (Eigen::Index i = 0; i < table.rows(); ++i) {
    table.row(i) = Eigen::Map<const Eigen::RowVectorXd>(rows[static_cast<std::size_t>(i)].data(), table.cols());
  }
  return table;
}

SelfCalFolder::SelfCalFolder(std::string path) : path_(std::move(path)) {
  if (fs::exists(file("IdMat.dat"))) {
    cameras_ = static_cast<int>(read_number_table(file("IdMat.dat")).rows());
  } else if (fs::exists(file("points.dat"))) {
    cameras_ = static_cast<int>(read_number_table(file("points.dat")).rows() / 3);
  } else if (fs::exists(file("Pmatrices.dat"))) {
    cameras_ = static_cast<int>(read_number_table(file("Pmatrices.dat")).rows() / 3);
  } else {
    while (cameras_ < kMaxCameras &&
           (first_of("cam", cameras_ + 1, ".points4cal.dat") || first_of("camera", cameras_ + 1, ".Pmat.cal"))) {
      ++cameras_;
    }
  }
  if (cameras_ > kMaxCameras) throw Error("{}: {} cameras; a folder has at most {}", path_, cameras_, kMaxCameras);
  if (cameras_ == 0) {
    throw Error(
        "{}: this is not a MultiCamSelfCal folder: there is no points.dat, camN.points4cal.dat, cameraN.Pmat.cal or Pmatrices.dat "
        "in "
        "it",
        path_);
  }
  for (int i = 0; i < cameras_; ++i) names_.push_back(fmt::format("cam{}", i + 1));
  std::ifstream order(file("camera_order.txt"));
  std::vector<std::string> given;
  for (std::string line; std::getline(order, line);) {
    while (!line.empty() && static_cast<unsigned char>(line.back()) <= ' ') line.pop_back();
    if (!line.empty() && line.find_first_of("/\\,=\"") == std::string::npos) given.push_back(line);
  }
  if (std::ssize(given) == cameras_ && std::set(given.begin(), given.end()).size() == given.size()) names_ = given;
}

bool SelfCalFolder::is_one(const std::string& path) {
  if (!fs::is_directory(path)) return false;
  for (const char* name : {"points.dat", "cam1.points4cal.dat", "camera1.Pmat.cal", "Pmatrices.dat"}) {
    if (fs::exists(fs::path(path) / name)) return true;
  }
  return false;
}

std::string SelfCalFolder::file(const std::string& name) const {
  return (fs::path(path_) / name).string();
}

/// "camera1.Pmat.cal": what stands `before` may be anything where it is empty.
std::optional<std::string> SelfCalFolder::first_of(const std::string& before, int number, const std::string& after) const {
  const std::string name = fmt::format("{}{}{}", before, number, after);
  if (!before.empty()) return fs::exists(file(name)) ? std::optional(file(name)) : std::nullopt;
  std::optional<std::string> best;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(path_, error)) {
    const std::string found = entry.path().filename().string();
    if (!found.ends_with(name)) continue;
    const char left = found.size() > name.size() ? found[found.size() - name.size() - 1] : 'a';
    if (left >= '0' && left <= '9') continue;  // 11.rad is not 1.rad
    if (!best || file(found) < *best) best = file(found);
  }
  return best;
}

bool SelfCalFolder::has_points() const {
  return fs::exists(file("points.dat")) || first_of("cam", 1, ".points4cal.dat");
}

std::vector<SelfCalFolder::Point> SelfCalFolder::points() const {
  return fs::exists(file("points.dat")) ? points_of_table() : points_of_lists();
}

std::vector<SelfCalFolder::Point> SelfCalFolder::points_of_table() const {
  std::vector<Point> result;
  const Eigen::MatrixXd locations = read_number_table(file("points.dat"));
  if (locations.rows() != 3 * cameras_)
    throw Error("{}: {} rows for {} cameras; there must be three for each", file("points.dat"), locations.rows(), cameras_);
  Eigen::MatrixXd detected = Eigen::MatrixXd::Ones(cameras_, locations.cols());
  if (fs::exists(file("IdMat.dat"))) detected = read_number_table(file("IdMat.dat"));
  if (detected.cols() != locations.cols()) {
    throw Error("{}: {} columns, and {} in points.dat; they must agree", file("IdMat.dat"), detected.cols(), locations.cols());
  }
  for (Eigen::Index frame = 0; frame < locations.cols(); ++frame) {
    for (int camera = 0; camera < cameras_; ++camera) {
      const Vector<3> location = locations.block<3, 1>(3 * camera, frame);
      if (!(detected(camera, frame) > 0) || !location.allFinite() || location.z() == 0) continue;
      result.push_back({camera, frame, location.head<2>()});
    }
  }
  return result;
}

std::vector<SelfCalFolder::Point> SelfCalFolder::points_of_lists() const {
  std::vector<Point> result;
  std::vector<std::vector<SpacePoint>> rows(static_cast<std::size_t>(cameras_));
  for (int camera = 0; camera < cameras_; ++camera) {
    const auto path = first_of("cam", camera + 1, ".points4cal.dat");
    if (!path) continue;
    const Eigen::MatrixXd table = read_number_table(*path);
    if (table.cols() != 7)
      throw Error("{}: {} columns; there must be seven: the point in space (4) and in the image (3)", *path, table.cols());
    std::map<SpacePoint, int> times;
    for (Eigen::Index i = 0; i < table.rows(); ++i) {
      if (!table.row(i).allFinite()) continue;
      SpacePoint point{table(i, 0), table(i, 1), table(i, 2), 0};
      point[3] = times[point]++;
      rows[static_cast<std::size_t>(camera)].push_back(point);
      result.push_back({camera, 0, table.block<1, 2>(i, 4).transpose()});
    }
  }
  const auto rank = ranks(rows);
  auto at = result.begin();
  for (const auto& camera : rows) {
    for (const SpacePoint& point : camera) (at++)->frame = rank.at(point);
  }
  std::stable_sort(result.begin(), result.end(), [](const Point& a, const Point& b) { return a.frame < b.frame; });
  return result;
}

std::optional<cv::Size> SelfCalFolder::size(int camera) const {
  if (!fs::exists(file("Res.dat"))) return std::nullopt;
  const Eigen::MatrixXd table = read_number_table(file("Res.dat"));
  if (table.cols() != 2 || table.rows() <= camera)
    throw Error("{}: there must be width and height for each of {} cameras", file("Res.dat"), cameras_);
  const double width = table(camera, 0), height = table(camera, 1);
  if (!(width >= 1 && height >= 1 && width <= 1e5 && height <= 1e5))
    throw Error("{}: an image of {} x {} px is not one", file("Res.dat"), width, height);
  return cv::Size(static_cast<int>(width), static_cast<int>(height));
}

std::optional<geometry::BrownLens> SelfCalFolder::lens(int camera) const {
  const auto path = first_of("", camera + 1, ".rad");
  if (!path) return std::nullopt;
  std::ifstream in = opened(*path);
  std::map<std::string, double> values;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    const auto sign = line.find('=');
    if (sign == std::string::npos) continue;
    std::string key = line.substr(0, sign);
    key.erase(std::remove_if(key.begin(), key.end(), [](char c) { return c == ' ' || c == '\t'; }), key.end());
    if (!key.starts_with('K') && !key.starts_with("kc")) continue;  // comments = '...', and what else the toolbox notes
    const auto value = numbers_of(std::string_view(line).substr(sign + 1), *path, number);
    if (value.size() == 1 && std::isfinite(value[0])) values[key] = value[0];
  }
  const auto value = [&](const char* key) {
    const auto at = values.find(key);
    if (at == values.end()) throw Error("{}: {} is missing; a lens file holds K11 … K33 and kc1 … kc4", *path, key);
    return at->second;
  };
  geometry::BrownLens lens;
  lens.focal = {value("K11"), value("K22")};
  lens.principal = {value("K13"), value("K23")};
  if (!(lens.focal.minCoeff() > 0)) throw Error("{}: focal length is {}; it must be positive", *path, lens.focal.minCoeff());
  for (std::size_t i = 0; i < 4; ++i) lens.distortion[i] = value(fmt::format("kc{}", i + 1).c_str());
  if (values.contains("kc5")) lens.distortion[4] = values["kc5"];
  return lens;
}

std::optional<Eigen::Matrix<double, 3, 4>> SelfCalFolder::projection(int camera) const {
  if (const auto path = first_of("camera", camera + 1, ".Pmat.cal")) {
    const Eigen::MatrixXd table = read_number_table(*path);
    if (table.rows() != 3 || table.cols() != 4) throw Error("{}: a projection matrix has 3 rows of 4 numbers", *path);
    return Eigen::Matrix<double, 3, 4>(table);
  }
  if (!fs::exists(file("Pmatrices.dat"))) return std::nullopt;
  const Eigen::MatrixXd table = read_number_table(file("Pmatrices.dat"));
  if (table.rows() != 3 * cameras_ || table.cols() != 4) {
    throw Error("{}: there must be 3 rows of 4 numbers for each of {} cameras", file("Pmatrices.dat"), cameras_);
  }
  return Eigen::Matrix<double, 3, 4>(table.middleRows(3 * camera, 3));
}

std::optional<Eigen::Matrix<double, 3, Eigen::Dynamic>> SelfCalFolder::world_points(int camera) const {
  const auto path = first_of("cam", camera + 1, ".points4cal.dat");
  if (!path) return std::nullopt;
  const Eigen::MatrixXd table = read_number_table(*path);
  if (table.cols() != 7) return std::nullopt;
  return table.leftCols(3).transpose();
}

double SelfCalFolder::unit() const {
  std::ifstream in(file("calibration_units.txt"));
  std::string word;
  in >> word;
  return word == "millimeters" || word == "mm" ? 0.001 : 1.0;
}

}  // namespace marey::format::rig
