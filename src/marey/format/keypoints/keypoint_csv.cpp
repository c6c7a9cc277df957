// DeepLabCut's CSV: rows "scorer", ["individuals"], "bodyparts", "coords" on top, then frame, x, y, likelihood, …. SLEAP's analysis
// CSV: a row of names on top, track, frame_idx, instance.score, NAME.x, NAME.y, NAME.score, …. Empty cells and nan are absent.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/format/keypoints/sequence_builder.h"

namespace marey::format::keypoints {
namespace {

using Cells = std::vector<std::string_view>;

/// The lines' cells; no quotes, as neither program writes any.
class CsvLines {
 public:
  explicit CsvLines(std::string_view text) : rest_(text) {}

  /// False at the end. Empty lines are skipped.
  bool next(Cells& cells) {
    std::string_view line;
    do {
      if (rest_.empty()) return false;
      const std::size_t end = rest_.find('\n');
      line = rest_.substr(0, end);
      rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
      if (line.ends_with('\r')) line.remove_suffix(1);
      ++number_;
    } while (line.empty());
    cells.clear();
    for (std::size_t from = 0; from <= line.size();) {
      const std::size_t comma = std::min(line.find(',', from), line.size());
      cells.push_back(line.substr(from, comma - from));
      from = comma + 1;
    }
    return true;
  }
  int number() const { return number_; }

 private:
  std::string_view rest_;
  int number_ = 0;
};

/// NaN for a cell that is empty or says so. Throws Error for anything else that is no number.
double cell_number(std::string_view cell, const std::string& where) {
  if (cell.empty() || cell == "nan" || cell == "NaN") return std::nan("");
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size()) throw Error("{}: \"{}\" is no number", where, cell.substr(0, 40));
  return value;
}

FilePoint file_point(double x, double y, double confidence) {
  const bool absent = std::isnan(x) || std::isnan(y);
  return {absent ? 0 : x, absent ? 0 : y, absent ? 0 : std::isnan(confidence) ? 1 : confidence};
}

KeypointSequence read_deeplabcut(CsvLines lines, const std::string& path, std::string_view set) {
  Cells row;
  std::vector<std::string> individuals, parts, coordinates;
  const auto keep = [&](std::vector<std::string>& names) { names.assign(row.begin() + 1, row.end()); };
  while (lines.next(row)) {
    if (row[0] == "individuals") keep(individuals);
    if (row[0] == "bodyparts") keep(parts);
    if (row[0] == "coords") {
      keep(coordinates);
      break;
    }
  }
  if (parts.empty() || parts.size() != coordinates.size() || parts.size() % 3 != 0)
    throw Error("{}: is not a table of DeepLabCut: \"bodyparts\" and \"coords\" must name x, y, likelihood of each point", path);
  if (individuals.empty()) individuals.assign(parts.size(), "");
  std::vector<std::string> names;
  for (std::size_t i = 0; i < parts.size() && individuals[i] == individuals[0]; i += 3) names.push_back(parts[i]);
  SequenceBuilder builder(path);
  builder.name_points(names);
  while (lines.next(row)) {
    const std::string where = fmt::format("{}:{}", path, lines.number());
    if (row.size() != parts.size() + 1) throw Error("{}: has {} cells, and {} are named", where, row.size(), parts.size() + 1);
    std::int64_t frame = frame_number_in(row[0]);
    builder.add_frame(frame);
    for (std::size_t person = 0; person + 3 * names.size() <= parts.size(); person += 3 * names.size()) {
      std::vector<FilePoint> points;
      for (std::size_t i = person + 1; i < person + 1 + 3 * names.size(); i += 3)
        points.push_back(file_point(cell_number(row[i], where), cell_number(row[i + 1], where), cell_number(row[i + 2], where)));
      builder.add(frame, points, 1, where);
    }
  }
  return builder.finish(set);
}

KeypointSequence read_sleap(CsvLines lines, const std::string& path, std::string_view set) {
  Cells row;
  lines.next(row);
  const auto column = [&](std::string_view name) { return std::find(row.begin(), row.end(), name) - row.begin(); };
  const auto frame_column = static_cast<std::size_t>(column("frame_idx")),
             score_column = static_cast<std::size_t>(column("instance.score"));
  struct Columns {
    std::size_t x, y, score;
  };
  std::vector<std::string> names;
  std::vector<Columns> columns;
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (!row[i].ends_with(".x")) continue;
    names.emplace_back(row[i].substr(0, row[i].size() - 2));
    columns.push_back(
        {i, static_cast<std::size_t>(column(names.back() + ".y")), static_cast<std::size_t>(column(names.back() + ".score"))});
    if (columns.back().y == row.size()) throw Error("{}:1: column {}.y is missing", path, names.back());
  }
  const std::size_t width = row.size();
  SequenceBuilder builder(path);
  builder.name_points(names);
  while (lines.next(row)) {
    const std::string where = fmt::format("{}:{}", path, lines.number());
    if (row.size() != width) throw Error("{}: has {} cells, and {} are named", where, row.size(), width);
    const auto value = [&](std::size_t i) { return i < width ? cell_number(row[i], where) : std::nan(""); };
    std::vector<FilePoint> points;
    for (const Columns& at : columns) points.push_back(file_point(value(at.x), value(at.y), value(at.score)));
    const double score = value(score_column);
    builder.add(frame_number_in(row[frame_column]), points, std::isnan(score) ? 1 : score, where);
  }
  return builder.finish(set);
}

}  // namespace

KeypointSequence read_keypoint_csv(std::string_view text, const std::string& path, std::string_view set) {
  const CsvLines lines(text);
  const std::string_view head = text.substr(0, text.find('\n'));
  if (head.starts_with("scorer")) return read_deeplabcut(lines, path, set);
  if (head.starts_with("frame,") && head.find(",point,x,y") != std::string_view::npos) return read_keypoint_rows(text, path, set);
  if (head.find("frame_idx") != std::string_view::npos) return read_sleap(lines, path, set);
  throw Error(
      "{}: is not a table of keypoints: DeepLabCut's begins with \"scorer\", SLEAP's names \"frame_idx\", Marey's \"point\"", path);
}

}  // namespace marey::format::keypoints
