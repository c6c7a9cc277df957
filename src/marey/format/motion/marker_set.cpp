#include "marey/format/motion/marker_set.h"

#include <charconv>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>

#include "marey/core/error.h"
#include "marey/files/input_file.h"
#include "marey/files/text_safety.h"
#include "marey/format/format.h"
#include "marey/format/text_rows.h"

namespace marey::format::motion {
namespace {

std::string_view without_blanks(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  for (;;) {
    const auto comma = line.find(',');
    cells.push_back(without_blanks(line.substr(0, comma)));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

std::optional<double> number_in(std::string_view text) {
  double value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

Vector<3> position_in(const std::vector<std::string_view>& cells, const std::string& path, int line) {
  if (cells.size() != 4) throw Error("{}:{}: {} values where label,x,y,z are due", path, line, cells.size());
  Vector<3> location;
  for (int axis = 0; axis < 3; ++axis) {
    const auto value = number_in(cells[static_cast<std::size_t>(axis) + 1]);
    if (!value) throw Error("{}:{}: {} is not a length in m", path, line, shown(cells[static_cast<std::size_t>(axis) + 1]));
    location[axis] = *value;
  }
  return location;
}

}  // namespace

MarkerSet read_marker_set(const std::string& path) {
  InputStream file(path);
  if (!file) throw Error("{}: cannot be read; give a text file with one name a line, or CSV with the header label,x,y,z", path);
  MarkerSet set;
  std::set<std::string> known;
  bool with_places = false;
  int number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    const std::string_view text = without_blanks(line);
    if (text.empty() || text.front() == '#') continue;
    const auto cells = cells_of(text);
    if (set.labels.empty() && !with_places && cells == std::vector<std::string_view>{"label", "x", "y", "z"}) {
      with_places = true;
      continue;
    }
    if (with_places) set.locations.push_back(position_in(cells, path, number));
    const std::string label = plain_text(with_places ? cells.front() : text);
    if (label.empty()) throw Error("{}:{}: a marker without a name; give it one", path, number);
    if (!known.insert(label).second)
      throw Error("{}:{}: the name {} occurs twice; every marker needs its own", path, number, shown(label));
    set.labels.push_back(label);
  }
  if (set.labels.empty()) throw Error("{}: holds no name; write one a line, or CSV with the header label,x,y,z", path);
  return set;
}

namespace {

constexpr std::size_t kMaxLabel = 64;

/// One name a line, or the header label,x,y,z. Asked last: what else may be such a text?
bool is_labels(const Beginning& file) {
  if (!file.is_text() || file.text().empty()) return false;
  if (file.first_line() == "label,x,y,z") return true;
  int names = 0;  // one alone is any text
  TextLines lines(file.text());
  std::string_view line;
  while (lines.next(line)) {
    if (line.empty() || line.front() == '#') continue;
    if (line.size() > kMaxLabel || line.find_first_of(",;=<>{}[]\"") != std::string_view::npos || number_of(line)) return false;
    ++names;
  }
  return names > 1;
}

}  // namespace

Format labels_format() {
  return {.name = "labels",
          .title = "names of markers",
          .endings = {},
          .holds = Content::labels,
          .detail = "m; one name a line, or `label,x,y,z`: where each marker is at the beginning. For `--labels`",
          .is = is_labels,
          .facts = [](const std::string& path) -> std::vector<Fact> {
            const MarkerSet set = motion::read_marker_set(path);
            return {{"labels", set.labels}, {"with_places", std::string(set.has_positions() ? "yes" : "no")}};
          }};
}

}  // namespace marey::format::motion
