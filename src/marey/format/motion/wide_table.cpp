#include "marey/format/motion/wide_table.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>

#include "marey/core/error.h"

namespace marey::format::motion {
namespace {

constexpr double kMaxSeconds = 1e9;
constexpr double kMaxCoordinate = 1e9;
constexpr double kRotationError = 0.01;  // format: six printed digits are far within it

bool is_missing(std::string_view field) {
  if (field.empty() || field == "\"\"") return true;
  if (field.front() == '-') field.remove_prefix(1);
  const auto same = [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; };
  return std::ranges::equal(field, std::string_view("nan"), same);
}

}  // namespace

bool WideTableHead::next_line() {
  std::string_view text;
  if (!lines_.next(text)) return false;
  split_fields(text, table_.separator, fields_);
  return true;
}

const std::vector<std::string_view>& WideTableHead::line(const char* which) {
  if (!next_line()) throw Error("{}: ends before {}; the file is cut off", name_, which);
  return fields_;
}

namespace {

bool is_table_rate(double rate_hz) {
  return rate_hz > 1e-6 && rate_hz <= 1e9;
}

}  // namespace

void WideTableHead::set_rate(std::optional<double> rate_hz, const std::string& otherwise) {
  if (!rate_hz || !is_table_rate(*rate_hz)) fail(otherwise);
  info_.header.rate_hz = *rate_hz;
}

void WideTableHead::add_marker(std::string label, std::size_t x_column) {
  info_.tracks.push_back({TrackId(static_cast<int>(info_.tracks.size()) + 1), std::move(label), {}});
  table_.x_columns.push_back(x_column);
}

void WideTableHead::add_body(std::string label, WideBody body) {
  body.body = BodyId(static_cast<int>(info_.header.bodies.size()) + 1);
  Body named;
  named.id = body.body;
  named.label = std::move(label);
  info_.header.bodies.push_back(std::move(named));
  table_.bodies.push_back(body);
}

void WideTableHead::fail(const std::string& what) const {
  throw Error("{}:{}: {}", name_, std::max<std::size_t>(lines_.number(), 1), what);
}

std::unique_ptr<FileReader> WideTableHead::rows_of(std::unique_ptr<MappedFile> file) {
  if (table_.rows.data() == nullptr) table_.rows = lines_.rest();
  table_.first_line = lines_.number() + 1;
  return std::make_unique<WideTableReader>(std::move(file), name_, std::move(table_), std::move(info_), std::move(warnings_));
}

WideTableReader::WideTableReader(std::unique_ptr<MappedFile> file, std::string name, WideTable table, FileInfo info,
                                 std::vector<std::string> warnings)
    : file_(std::move(file)),
      name_(std::move(name)),
      table_(std::move(table)),
      info_(std::move(info)),
      warnings_(std::move(warnings)),
      lines_(table_.rows) {
  lines_.go_to(table_.rows, table_.first_line);
}

std::optional<Instant> WideTableReader::next() {
  std::string_view line;
  while (lines_.next(line)) {
    split_fields(line, table_.separator, fields_);
    if (std::all_of(fields_.begin(), fields_.end(), [](std::string_view field) { return field.empty(); })) continue;
    Instant frame = frame_of(fields_);
    last_index_ = frame.index;
    ++read_;
    return frame;
  }
  if (info_.frame_count && read_ != *info_.frame_count) {
    warnings_.push_back(fmt::format("{}: names {} frames and holds {}; is it cut off?", name_, *info_.frame_count, read_));
    info_.frame_count = read_;
  }
  return std::nullopt;
}

Instant WideTableReader::frame_of(const std::vector<std::string_view>& fields) {
  std::size_t needed = table_.x_columns.empty() ? 1 : table_.x_columns.back() + 3;
  for (const WideBody& body : table_.bodies) needed = std::max(needed, body.position_column + 3);
  if (!lines_.ended() && fields.size() < needed) {
    fail(fmt::format("ends within its row ({} of {} columns); the file is cut off", fields.size(), needed));
  }
  Instant frame;
  std::optional<std::int64_t> number = read_ + table_.first_frame_number;
  if (table_.frame_column)
    number = *table_.frame_column < fields.size() ? whole_number_of(fields[*table_.frame_column]) : std::nullopt;
  if (!number) fail(fmt::format("{} is no number of a frame", shown(fields.front())));
  if (*number < table_.first_frame_number && !last_index_) table_.first_frame_number = *number;
  frame.index = *number - table_.first_frame_number;
  if (frame.index < 0 || (last_index_ && frame.index <= *last_index_)) {
    fail(fmt::format("frame {} comes after frame {}; they must come in order", *number, *last_index_ + table_.first_frame_number));
  }
  double time = static_cast<double>(frame.index) / info_.header.rate_hz;
  if (table_.time_column && *table_.time_column < fields.size() && !is_missing(fields[*table_.time_column])) {
    const auto reported = number_of(fields[*table_.time_column]);
    if (!reported || std::abs(*reported) > kMaxSeconds)
      fail(fmt::format("{} is not a time in seconds", shown(fields[*table_.time_column])));
    time = *reported;
  }
  if (!(std::abs(time) <= kMaxSeconds)) fail(fmt::format("frame {} is too far from the first", *number));
  frame.time = timestamp_from_seconds(time);
  for (std::size_t track = 0; track < table_.x_columns.size(); ++track) {
    if (auto point = point_at(fields, track)) frame.samples.push_back(*point);
  }
  for (const WideBody& body : table_.bodies) {
    if (auto pose = pose_at(fields, body)) frame.bodies.push_back(*pose);
  }
  return frame;
}

std::optional<double> WideTableReader::number_at(const std::vector<std::string_view>& fields, std::size_t column) const {
  const std::string_view field = column < fields.size() ? fields[column] : std::string_view();
  if (is_missing(field)) return std::nullopt;
  const auto value = number_of(field);
  if (!value) fail(fmt::format("{} in column {} is no number", shown(field), column + 1));
  return value;
}

std::optional<BodyPose> WideTableReader::pose_at(const std::vector<std::string_view>& fields, const WideBody& body) const {
  const bool quaternion = body.rotation == WideBody::Rotation::quaternion_xyzw;
  std::array<double, 9> rotation{};
  for (std::size_t i = 0; i < (quaternion ? 4U : 9U); ++i) {
    const auto value = number_at(fields, body.rotation_column + i);
    if (!value) return std::nullopt;
    rotation[i] = *value;
  }
  BodyPose pose;
  pose.body = body.body;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto value = number_at(fields, body.position_column + axis);
    if (!value || std::abs(*value) > kMaxCoordinate) return std::nullopt;
    pose.world_from_body.translation[static_cast<Eigen::Index>(axis)] = *value * table_.unit_m;
  }
  const Eigen::Quaterniond turn = quaternion ? Eigen::Quaterniond(rotation[3], rotation[0], rotation[1], rotation[2])
                                             : Eigen::Quaterniond(Matrix<3>(Eigen::Map<const Matrix<3>>(rotation.data())));
  const Matrix<3> given = Eigen::Map<const Matrix<3>>(rotation.data());
  const bool is_rotation =
      quaternion ? std::abs(turn.norm() - 1) < kRotationError
                 : (given.transpose() * given - Matrix<3>::Identity()).norm() < kRotationError && given.determinant() > 0;
  if (!is_rotation) return std::nullopt;  // zeros: not tracked
  pose.world_from_body.rotation = turn.normalized().toRotationMatrix();
  return pose;
}

std::optional<Sample> WideTableReader::point_at(const std::vector<std::string_view>& fields, std::size_t track) const {
  const std::size_t column = table_.x_columns[track];
  Sample point;
  point.track = info_.tracks[track].id;
  int missing = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string_view field = column + axis < fields.size() ? fields[column + axis] : std::string_view();
    if (is_missing(field)) {
      ++missing;
      continue;
    }
    const auto value = number_of(field);
    if (!value) fail(fmt::format("{} in column {} is no number", shown(field), column + axis + 1));
    point.position[static_cast<Eigen::Index>(axis)] = *value * table_.unit_m;
  }
  if (missing == 3 || (missing == 0 && table_.zeros_are_missing && point.position.isZero(0))) return std::nullopt;
  if (missing > 0) fail(fmt::format("marker {} has {} of its 3 coordinates", shown(info_.tracks[track].label), 3 - missing));
  return point;
}

void WideTableReader::fail(const std::string& what) const {
  throw Error("{}:{}: {}", name_, lines_.number(), what);
}

WideTableWriter::WideTableWriter(const std::string& path, const WritePlan& plan)
    : PointSink(path), plan_(plan), row_(plan.info.tracks.size()) {
  for (std::size_t i = 0; i < row_.size(); ++i) column_[plan.info.tracks[i].id] = i;
}

void WideTableWriter::start(const RecordingHeader& header) {
  if (!is_table_rate(header.rate_hz)) throw Error("{}: {:g} Hz is not a rate that its head can tell", path(), header.rate_hz);
  file_.emplace(path());
  file_->write(head(header));
  rate_hz_ = header.rate_hz;
  next_ = plan_.first_frame;
}

void WideTableWriter::write(const Instant& frame) {
  fill_to(frame.index, frame.time);
  put(frame.index, frame.time, frame.samples);
  last_time_ = frame.time;
}

void WideTableWriter::finish() {
  fill_to(plan_.last_frame + 1, std::nullopt);
  file_->finish();
}

void WideTableWriter::fill_to(std::int64_t index, std::optional<Timestamp> time) {
  const std::int64_t before = next_ - 1;
  const auto from = [&](Timestamp known, std::int64_t frames) {
    return timestamp_from_seconds(seconds(known) + static_cast<double>(frames) / rate_hz_);
  };
  while (next_ < index) {
    Timestamp here = timestamp_from_seconds(static_cast<double>(next_) / rate_hz_);
    if (last_time_ && time) {
      const double part = static_cast<double>(next_ - before) / static_cast<double>(index - before);
      here = timestamp_from_seconds(seconds(*last_time_) + part * (seconds(*time) - seconds(*last_time_)));
    } else if (last_time_) {
      here = from(*last_time_, next_ - before);
    } else if (time) {
      here = from(*time, next_ - index);
    }
    put(next_, here, {});
  }
}

void WideTableWriter::put(std::int64_t index, Timestamp time, std::span<const Sample> points) {
  std::fill(row_.begin(), row_.end(), nullptr);
  for (const Sample& point : points) {
    const auto column = column_.find(point.track);
    if (column != column_.end()) row_[column->second] = &point;
  }
  text_.clear();
  append_row(text_, index, time, row_);
  file_->write(text_);
  next_ = index + 1;
}

}  // namespace marey::format::motion
