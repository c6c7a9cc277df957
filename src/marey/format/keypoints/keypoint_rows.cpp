// What `marey track --targets keypoints` writes. JSON lines, one for each person and frame: {"frame", "time", "id", …, "keypoints":
// {"presence", "points": {NAME: [x, y, sd, visibility, presence], …}}}. CSV, a row for each point:
// frame,time,id,point,x,y,sd,visibility,presence.
#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "marey/core/error.h"
#include "marey/core/keypoint_sets.h"
#include "marey/format/csv_table.h"
#include "marey/format/keypoints/sequence_builder.h"
#include "marey/format/nesting.h"

namespace marey::format::keypoints {
namespace {

using nlohmann::json;

struct NamedPerson {
  std::int64_t frame = 0;
  double presence = 1;
  std::map<std::string, FilePoint> points;  // by common name
  std::string where;
};

/// The smallest known set that has all these points; without any, the points as they are.
std::vector<std::string> set_with(const std::vector<std::string>& names) {
  const KeypointSet* best = nullptr;
  for (const KeypointSet& set : keypoint_sets()) {
    const bool all =
        std::all_of(names.begin(), names.end(), [&](const std::string& name) { return point_named(set, name).has_value(); });
    if (all && (best == nullptr || set.points.size() < best->points.size())) best = &set;
  }
  return best == nullptr ? names : best->points;
}

/// Gathers people whose points have names; each person has only those that were found.
class NamedPeople {
 public:
  explicit NamedPeople(const std::string& path) : builder_(path) {}

  void add_time(std::int64_t frame, double time_s) { builder_.add_frame(frame, time_s); }
  void add(NamedPerson person) {
    for (const auto& [name, point] : person.points) {
      if (std::find(names_.begin(), names_.end(), name) == names_.end()) names_.push_back(name);
    }
    people_.push_back(std::move(person));
  }
  KeypointSequence finish(std::string_view set) {
    const std::vector<std::string> names = set.empty() ? set_with(names_) : keypoint_set_named(set).points;
    builder_.name_points(names);
    for (const NamedPerson& person : people_) {
      std::vector<FilePoint> points(names.size());
      for (const auto& [name, point] : person.points) {
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end()) throw Error("{}: keypoint set {} has no point {}", person.where, set, name);
        points[static_cast<std::size_t>(found - names.begin())] = point;
      }
      builder_.add(person.frame, points, person.presence, person.where);
    }
    return builder_.finish({});
  }

 private:
  SequenceBuilder builder_;
  std::vector<std::string> names_;
  std::vector<NamedPerson> people_;
};

void add_line(const json& line, const std::string& where, NamedPeople& people) {
  NamedPerson person{.frame = line.at("frame").get<std::int64_t>(), .presence = 1, .points = {}, .where = where};
  people.add_time(person.frame, line.at("time").get<double>());
  const auto keypoints = line.find("keypoints");
  if (keypoints == line.end()) return;
  person.presence = keypoints->value("presence", 1.0);
  for (const auto& [name, values] : keypoints->at("points").items()) {
    const auto number = [&](std::size_t i) { return values.at(i).get<double>(); };
    person.points[common_keypoint_name(name)] = {
        .x = number(0), .y = number(1), .confidence = number(3) * number(4), .sigma = number(2)};
  }
  people.add(std::move(person));
}

double number_in(const CsvTable::Row& row, const char* column) {
  const std::string text = row.text(column);
  try {
    std::size_t used = 0;
    const double value = std::stod(text, &used);
    if (used == text.size()) return value;
  } catch (const std::logic_error&) {  // the sentence below
  }
  throw Error("{}: \"{}\" in column {} is no number", row.where(), text, column);
}

}  // namespace

KeypointSequence read_keypoint_lines(std::string_view text, const std::string& path, std::string_view set) {
  NamedPeople people(path);
  int number = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(text.size(), end + 1));
    const std::string where = fmt::format("{}:{}", path, ++number);
    if (line.empty()) continue;
    check_nesting(line, Notation::json, where);
    try {
      add_line(json::parse(line), where, people);
    } catch (const json::exception&) {
      throw Error("{}: is not a line of keypoints: it breaks off, or a field is missing or of another kind", where);
    }
  }
  return people.finish(set);
}

KeypointSequence read_keypoint_rows(std::string_view text, const std::string& path, std::string_view set) {
  const CsvTable table(text, path, {"frame", "id", "point", "x", "y", "sd"}, {"time", "visibility", "presence"});
  std::map<std::pair<std::int64_t, std::string>, NamedPerson> rows;
  NamedPeople people(path);
  for (const CsvTable::Row& row : table.rows()) {
    const auto frame = static_cast<std::int64_t>(number_in(row, "frame"));
    const auto fraction = [&](const char* column) { return row.text(column).empty() ? 1 : number_in(row, column); };
    if (!row.text("time").empty()) people.add_time(frame, number_in(row, "time"));
    NamedPerson& person = rows[{frame, row.text("id")}];
    person.frame = frame;
    person.where = row.where();
    person.points[common_keypoint_name(row.text("point"))] = {.x = number_in(row, "x"),
                                                              .y = number_in(row, "y"),
                                                              .confidence = fraction("visibility") * fraction("presence"),
                                                              .sigma = number_in(row, "sd")};
  }
  for (auto& [key, person] : rows) people.add(std::move(person));
  return people.finish(set);
}

}  // namespace marey::format::keypoints
