#include "marey/format/motion/wide_table.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "marey/core/error.h"

namespace marey::format::motion {
namespace {

constexpr double kLargestSeconds = 1e9;

bool is_missing(std::string_view field) {
  return field.empty() || field == "NaN" || field == "nan" || field == "NAN" || field == "-nan" || field == "\"\"";
}

}  // namespace

WideTableReader::WideTableReader(std::unique_ptr<MappedFile> file, std::string name, WideTable table, MotionInfo info,
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
  const std::size_t needed = table_.x_columns.empty() ? 1 : table_.x_columns.back() + 3;
  if (!lines_.ended() && fields.size() < needed) {
    fail(fmt::format("ends within its row ({} of {} columns); the file is cut off", fields.size(), needed));
  }
  Instant frame;
  const auto number = table_.frame_column < fields.size() ? whole_number_of(fields[table_.frame_column]) : std::nullopt;
  if (!number) fail(fmt::format("{} is no number of a frame", shown(fields.front())));
  if (*number < table_.first_frame_number && !last_index_) table_.first_frame_number = *number;
  frame.index = *number - table_.first_frame_number;
  if (frame.index < 0 || (last_index_ && frame.index <= *last_index_)) {
    fail(fmt::format("frame {} comes after frame {}; they must come in order", *number, *last_index_ + table_.first_frame_number));
  }
  double time = static_cast<double>(frame.index) / info_.header.rate_hz;
  if (table_.time_column && *table_.time_column < fields.size() && !is_missing(fields[*table_.time_column])) {
    const auto told = number_of(fields[*table_.time_column]);
    if (!told || std::abs(*told) > kLargestSeconds)
      fail(fmt::format("{} is no time in seconds", shown(fields[*table_.time_column])));
    time = *told;
  }
  if (!(std::abs(time) <= kLargestSeconds)) fail(fmt::format("frame {} is too far from the first", *number));
  frame.time = timestamp_from_seconds(time);
  for (std::size_t track = 0; track < table_.x_columns.size(); ++track) {
    if (auto point = point_at(fields, track)) frame.samples.push_back(*point);
  }
  return frame;
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
  if (missing == 3) return std::nullopt;
  if (missing > 0) fail(fmt::format("marker {} has {} of its 3 coordinates", shown(info_.tracks[track].label), 3 - missing));
  return point;
}

void WideTableReader::fail(const std::string& what) const {
  throw Error("{}:{}: {}", name_, lines_.number(), what);
}

}  // namespace marey::format::motion
