#include "marey/format/skeleton/motion_table.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <numbers>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/recording.h"
#include "marey/files/text_safety.h"
#include "marey/files/whole_file.h"
#include "marey/format/read_file.h"
#include "marey/format/text_rows.h"

namespace marey::format::skeleton {
namespace {

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t at = 0; at < line.size();) {
    const std::size_t begin = line.find_first_not_of(" \t\r,", at);
    if (begin == std::string_view::npos) break;
    const std::size_t end = std::min(line.find_first_of(" \t\r,", begin), line.size());
    cells.push_back(line.substr(begin, end - begin));
    at = end;
  }
  return cells;
}

std::string lower(std::string_view text) {
  std::string small(text);
  for (char& c : small) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return small;
}

/// The lines down to "endheader".
void read_table_head(TextLines& lines, const std::string& name, MotionTable& table) {
  std::string_view line;
  for (bool first = true; lines.next(line); first = false) {
    const std::string small = lower(line.substr(0, line.find_last_not_of(" \t\r,") + 1));
    if (small == "endheader") return;
    if (first && small.find('=') == std::string::npos) table.title = plain_text(line.substr(0, small.size()));
    if (small.starts_with("indegrees")) table.in_degrees = small.find("yes") != std::string::npos;
    if (small.starts_with("datatype") && small.find("double") == std::string::npos)
      throw Error("{}:{}: a table of {}; Marey reads tables of double", name, lines.number(), shown(line));
  }
  throw Error("{}: has no line \"endheader\", as .mot and .sto files have", name);
}

}  // namespace

MotionTable parse_motion_table(std::string_view text, const std::string& name) {
  TextLines lines(text);
  MotionTable table;
  read_table_head(lines, name, table);
  std::string_view line;
  while (lines.next(line)) {
    const auto cells = cells_of(line);
    if (cells.empty()) continue;
    if (table.columns.empty()) {
      if (lower(cells.front()) != "time" || cells.size() < 2)
        throw Error("{}:{}: the columns do not begin with \"time\"", name, lines.number());
      for (std::size_t i = 1; i < cells.size(); ++i) table.columns.push_back(plain_text(cells[i]));
      continue;
    }
    if (cells.size() != table.columns.size() + 1)
      throw Error("{}:{}: {} numbers under {} columns", name, lines.number(), cells.size(), table.columns.size() + 1);
    const auto time = number_of(cells.front());
    if (!time || std::abs(*time) > 1e9) throw Error("{}:{}: {} is not a time", name, lines.number(), shown(cells.front()));
    table.times.push_back(*time);
    std::vector<std::optional<double>> row;
    for (std::size_t i = 1; i < cells.size(); ++i) row.push_back(number_of(cells[i]));
    table.rows.push_back(std::move(row));
  }
  if (table.columns.empty()) throw Error("{}: has no line of columns", name);
  return table;
}

MotionTable read_motion_table(const std::string& path) {
  return parse_motion_table(read_file(path), path);
}

SkeletonMotion motion_of(const MotionTable& table, const Skeleton& skeleton, bool in_degrees) {
  SkeletonMotion motion;
  std::vector<Recording::TimeStep> time_steps;
  const bool degrees = table.in_degrees.value_or(in_degrees);
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    std::vector<double> row = skeleton.rest();
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      const auto coordinate = skeleton.coordinate(table.columns[c]);
      if (!coordinate || !table.rows[r][c]) continue;
      const auto i = static_cast<std::size_t>(*coordinate);
      row[i] = *table.rows[r][c] * (degrees && skeleton.coordinates[i].is_rotation ? std::numbers::pi / 180 : 1);
    }
    motion.rows.push_back(std::move(row));
    motion.times.push_back(timestamp_from_seconds(table.times[r]));
    time_steps.push_back({static_cast<std::int64_t>(r), motion.times.back()});
  }
  motion.rate_hz = median_rate_hz(time_steps).value_or(kDefaultRate);
  return motion;
}

void write_motion_table(const std::string& path, const Skeleton& skeleton, const SkeletonMotion& motion) {
  MotionTable table{.title = "Coordinates", .in_degrees = true, .columns = {}, .times = {}, .rows = {}};
  for (const Coordinate& coordinate : skeleton.coordinates) table.columns.push_back(coordinate.name);
  for (std::size_t r = 0; r < motion.rows.size(); ++r) {
    table.times.push_back(seconds(motion.times[r]));
    std::vector<std::optional<double>> row;
    for (std::size_t c = 0; c < table.columns.size(); ++c)
      row.emplace_back(motion.rows[r][c] * (skeleton.coordinates[c].is_rotation ? 180 / std::numbers::pi : 1));
    table.rows.push_back(std::move(row));
  }
  write_motion_table(path, table);
}

void write_motion_table(const std::string& path, const MotionTable& table) {
  WholeFile file(path);
  std::string text = fmt::format("{}\nversion=1\nnRows={}\nnColumns={}\ninDegrees={}\nendheader\ntime", table.title,
                                 table.rows.size(), table.columns.size() + 1, table.in_degrees.value_or(true) ? "yes" : "no");
  for (const std::string& column : table.columns) {
    std::string word = plain_text(column);
    std::replace(word.begin(), word.end(), ' ', '_');
    text += '\t' + word;
  }
  text += '\n';
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    auto out = std::back_inserter(text);
    fmt::format_to(out, "{:.8f}", table.times[r]);
    for (const auto& value : table.rows[r]) {
      if (value) {
        fmt::format_to(out, "\t{:.8f}", *value);
      } else {
        text += "\tNaN";
      }
    }
    text += '\n';
    if (text.size() > (1U << 20)) {
      file.write(text);
      text.clear();
    }
  }
  file.write(text);
  file.finish();
}

}  // namespace marey::format::skeleton
