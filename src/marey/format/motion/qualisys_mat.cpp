// Qualisys Track Manager's MAT export: one structure with FrameRate, Frames, Trajectories.Labeled {Count, Labels, Data of markers ×
// 4 × frames: x, y, z, residual} and RigidBodies {Name, Positions of bodies × 3 × frames, Rotations of bodies × 9 × frames, column
// by column}. mm; missing values are NaN. Reference: QTM user manual, "MAT file format".
#include <cmath>
#include <memory>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/format/mapped_file.h"
#include "marey/format/motion/mat_file.h"
#include "marey/format/motion/motion_csv.h"

namespace marey::format::motion {
namespace {

constexpr double kMatUnitM = 0.001;         // format: mm
constexpr double kMatRotationError = 0.01;  // format: six printed digits are far within it

/// Rows × columns × frames of numbers.
class MatCube {
 public:
  MatCube() = default;
  MatCube(const MatValue& value, std::size_t columns, const std::string& what, const std::string& name) {
    if (value.dimensions.size() < 2 || value.dimensions[1] != columns || value.dimensions.size() > 3)
      throw Error("{}: its {} are not of N x {} x frames", name, what, columns);
    rows_ = value.dimensions[0];
    columns_ = columns;
    frames_ = value.dimensions.size() == 3 ? value.dimensions[2] : 1;
    numbers_ = value.numbers;
    if (numbers_.size() != rows_ * columns_ * frames_) throw Error("{}: its {} are cut off", name, what);
  }

  std::size_t rows() const { return rows_; }
  std::size_t frames() const { return frames_; }
  double at(std::size_t row, std::size_t column, std::size_t frame) const {
    return numbers_[row + rows_ * (column + columns_ * frame)];
  }

 private:
  std::size_t rows_ = 0, columns_ = 0, frames_ = 0;
  std::vector<double> numbers_;
};

std::vector<std::string> texts_of(const MatValue* value) {
  std::vector<std::string> texts;
  if (value == nullptr) return texts;
  for (const MatValue& cell : value->children) texts.push_back(cell.text);
  if (texts.empty() && !value->text.empty()) texts.push_back(value->text);
  return texts;
}

double number_in(const MatValue& value, std::string_view field, double otherwise) {
  const MatValue* number = value.field(field);
  return number != nullptr && number->numbers.size() == 1 && std::isfinite(number->numbers[0]) ? number->numbers[0] : otherwise;
}

class QualisysMatReader : public FileReader {
 public:
  QualisysMatReader(std::string_view bytes, const std::string& name) {
    const std::vector<MatValue> variables = read_mat(bytes, name);
    const MatValue* measurement = nullptr;
    for (const MatValue& variable : variables) {
      if (variable.field("FrameRate") != nullptr &&
          (variable.field("Trajectories") != nullptr || variable.field("RigidBodies") != nullptr))
        measurement = &variable;
    }
    if (measurement == nullptr)
      throw Error("{}: is a MAT-file without a measurement of Qualisys Track Manager's (FrameRate, Trajectories)", name);
    info_.header.rate_hz = number_in(*measurement, "FrameRate", 0);
    if (!(info_.header.rate_hz > 1e-6 && info_.header.rate_hz < 1e9)) throw Error("{}: does not specify its FrameRate", name);
    info_.header.made_by.program = "Qualisys Track Manager";
    if (const MatValue* data = measurement->at("Trajectories.Labeled.Data"); data != nullptr && !data->numbers.empty())
      find_markers(MatCube(*data, 4, "labelled trajectories", name), texts_of(measurement->at("Trajectories.Labeled.Labels")));
    if (const MatValue* positions = measurement->at("RigidBodies.Positions"); positions != nullptr && !positions->numbers.empty()) {
      const MatValue* rotations = measurement->at("RigidBodies.Rotations");
      if (rotations == nullptr) throw Error("{}: its rigid bodies have no Rotations", name);
      find_bodies(MatCube(*positions, 3, "positions of rigid bodies", name),
                  MatCube(*rotations, 9, "rotations of rigid bodies", name), texts_of(measurement->at("RigidBodies.Name")), name);
    }
    if (frames() == 0) throw Error("{}: has neither labelled trajectories nor rigid bodies", name);
    if (markers_.frames() > 0 && positions_.frames() > 0 && markers_.frames() != positions_.frames())
      throw Error("{}: has {} frames of markers and {} of rigid bodies", name, markers_.frames(), positions_.frames());
    info_.frame_count = static_cast<std::int64_t>(frames());
  }

  const FileInfo& info() const override { return info_; }
  std::vector<std::string> warnings() const override { return {}; }

  std::optional<Instant> next() override {
    if (at_ == frames()) return std::nullopt;
    Instant instant;
    instant.index = static_cast<std::int64_t>(at_);
    instant.time = timestamp_from_seconds(static_cast<double>(at_) / info_.header.rate_hz);
    for (std::size_t i = 0; i < info_.tracks.size(); ++i) add_marker(instant, i);
    for (std::size_t i = 0; i < info_.header.bodies.size(); ++i) add_body(instant, i);
    ++at_;
    return instant;
  }

 private:
  std::size_t frames() const { return std::max(markers_.frames(), positions_.frames()); }

  void find_markers(MatCube markers, const std::vector<std::string>& labels) {
    markers_ = std::move(markers);
    for (std::size_t i = 0; i < markers_.rows(); ++i)
      info_.tracks.push_back({TrackId(static_cast<int>(i) + 1), i < labels.size() ? labels[i] : std::string(), {}});
  }

  void find_bodies(MatCube positions, MatCube rotations, const std::vector<std::string>& labels, const std::string& name) {
    positions_ = std::move(positions);
    rotations_ = std::move(rotations);
    if (rotations_.rows() != positions_.rows() || rotations_.frames() != positions_.frames())
      throw Error("{}: its rigid bodies have other rotations than positions", name);
    for (std::size_t i = 0; i < positions_.rows(); ++i) {
      Body body;
      body.id = BodyId(static_cast<int>(i) + 1);
      body.label = i < labels.size() ? labels[i] : fmt::format("body {}", i + 1);
      info_.header.bodies.push_back(std::move(body));
    }
  }

  void add_marker(Instant& instant, std::size_t i) const {
    if (at_ >= markers_.frames()) return;
    Sample sample;
    sample.track = info_.tracks[i].id;
    for (std::size_t axis = 0; axis < 3; ++axis)
      sample.position[static_cast<Eigen::Index>(axis)] = kMatUnitM * markers_.at(i, axis, at_);
    if (!sample.position.allFinite() || sample.position.cwiseAbs().maxCoeff() > 1e6) return;
    const double residual = markers_.at(i, 3, at_);
    if (std::isfinite(residual) && residual > 0) sample.residual_m = kMatUnitM * residual;
    instant.samples.push_back(sample);
  }

  void add_body(Instant& instant, std::size_t i) const {
    Matrix<3> rotation;
    for (std::size_t k = 0; k < 9; ++k)
      rotation(static_cast<Eigen::Index>(k % 3), static_cast<Eigen::Index>(k / 3)) = rotations_.at(i, k, at_);
    BodyPose pose;
    pose.body = info_.header.bodies[i].id;
    for (std::size_t axis = 0; axis < 3; ++axis)
      pose.world_from_body.translation[static_cast<Eigen::Index>(axis)] = kMatUnitM * positions_.at(i, axis, at_);
    if (!rotation.allFinite() || !pose.world_from_body.translation.allFinite() || rotation.determinant() < 0 ||
        (rotation.transpose() * rotation - Matrix<3>::Identity()).norm() > kMatRotationError)
      return;
    pose.world_from_body.rotation = Eigen::Quaterniond(rotation).normalized().toRotationMatrix();
    instant.bodies.push_back(pose);
  }

  FileInfo info_;
  MatCube markers_, positions_, rotations_;
  std::size_t at_ = 0;
};

}  // namespace

std::unique_ptr<FileReader> open_qualisys_mat(const std::string& path) {
  const MappedFile file(path);
  return std::make_unique<QualisysMatReader>(file.text(), path);
}
std::unique_ptr<FileReader> read_qualisys_mat(std::string_view bytes, const std::string& name) {
  return std::make_unique<QualisysMatReader>(bytes, name);
}

Format qualisys_mat_format() {
  return {.name = "qualisys-mat",
          .title = "a MAT-file of Qualisys Track Manager's",
          .endings = {},
          .holds = Content::space,
          .detail =
              "mm; labelled markers and rigid bodies' poses, as Qualisys Track Manager exports them (MAT-file up to version 7). "
              "Untested on a maker's file",
          .is = [](const Beginning& file) { return file.bytes.starts_with("MATLAB 5.0") || file.bytes.starts_with("MATLAB 7.3"); },
          .open = [](const std::string& path, const ReadOptions&) { return motion::open_qualisys_mat(path); },
          .poses = true};
}

}  // namespace marey::format::motion
