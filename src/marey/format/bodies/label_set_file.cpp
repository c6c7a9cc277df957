#include "marey/format/bodies/label_set_file.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "marey/core/error.h"
#include "marey/files/text_safety.h"
#include "marey/files/whole_file.h"
#include "marey/format/format.h"
#include "marey/format/nesting.h"
#include "marey/format/read_file.h"
#include "marey/format/rig/rig_section.h"

namespace marey::format::bodies {
namespace {

constexpr std::size_t kMaxLabels = 2000;

/// Rows of `width` numbers each.
std::vector<std::vector<double>> rows_in(const toml::table& file, const char* key, std::size_t rows, std::size_t width,
                                         rig::Problems& problems) {
  const toml::array* array = file[key].as_array();
  if (array == nullptr || array->size() != rows) {
    problems.add(array == nullptr ? toml::source_region{} : array->source(),
                 fmt::format("{} must be {} rows of {} numbers, m", key, rows, width));
    return {};
  }
  std::vector<std::vector<double>> found;
  for (const toml::node& node : *array) {
    const toml::array* row = node.as_array();
    auto& numbers = found.emplace_back();
    for (std::size_t i = 0; row != nullptr && i < row->size(); ++i) {
      if (const auto number = row->get(i)->value<double>(); number && std::isfinite(*number)) numbers.push_back(*number);
    }
    if (row == nullptr || row->size() != width || numbers.size() != width) {
      problems.add(node.source(), fmt::format("a row of {} is {} numbers, m", key, width));
      return {};
    }
  }
  return found;
}

}  // namespace

LearnedMarkers parse_label_set(std::string_view text, const std::string& name) {
  check_nesting(text, Notation::toml, name);
  toml::table file;
  try {
    file = toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    throw Error("{}:{}: {}", name, std::max<unsigned>(1, error.source().begin.line), rig::excerpt(error.description(), 200));
  }
  rig::Problems problems(name);
  LearnedMarkers set;
  const toml::array* labels = file["labels"].as_array();
  std::set<std::string> known;
  if (labels == nullptr || labels->size() < 4 || labels->size() > kMaxLabels) {
    problems.add({}, fmt::format("labels must be a list of 4 to {} names", kMaxLabels));
    problems.throw_if_any();
  }
  for (const toml::node& node : *labels) {
    set.labels.push_back(plain_text(node.value<std::string>().value_or("")));
    if (set.labels.back().empty()) problems.add(node.source(), "a label is a text that is not empty");
    if (!known.insert(set.labels.back()).second)
      problems.add(node.source(), fmt::format("the label \"{}\" is there twice", set.labels.back()));
  }
  set.moves = file["moves"].value_or(true);
  set.scaled = file["scaled"].value_or(false);
  const std::size_t count = set.labels.size();
  for (const auto& row : rows_in(file, "places", count, 3, problems)) set.locations.push_back({row[0], row[1], row[2]});
  for (const auto& row : rows_in(file, "distances", count * (count - 1) / 2, 2, problems)) {
    if (row[0] < 0 || row[1] < 0) problems.add(file["distances"].node()->source(), "a distance or its deviation is below 0");
    set.distances.push_back({row[0], row[1]});
  }
  problems.throw_if_any();
  return set;
}

LearnedMarkers read_label_set(const std::string& path) {
  return parse_label_set(read_file(path), path);
}

std::string label_set_text(const LearnedMarkers& set) {
  std::string text = "labels = [";
  for (std::size_t m = 0; m < set.size(); ++m) {
    std::string label;
    for (const char c : plain_text(set.labels[m])) {
      if (c == '"' || c == '\\') label += '\\';
      label += c;
    }
    text += fmt::format("{}\"{}\"", m == 0 ? "" : ", ", label);
  }
  text += fmt::format("]\nmoves = {}\nscaled = {}\nplaces = [\n", set.moves, set.scaled);
  for (const Vector<3>& location : set.locations)
    text += fmt::format("  [{:.5f}, {:.5f}, {:.5f}],\n", location.x(), location.y(), location.z());
  text += "]\ndistances = [\n";
  for (std::size_t a = 1; a < set.size(); ++a) {
    text += " ";
    for (std::size_t b = 0; b < a; ++b)
      text += fmt::format(" [{:.5f}, {:.5f}],", set.between(a, b).mean, set.between(a, b).deviation);
    text += '\n';
  }
  return text + "]\n";
}

void write_label_set(const std::string& path, const LearnedMarkers& set) {
  WholeFile file(path);
  file.write(label_set_text(set));
  file.finish();
}

Format label_set_format() {
  return {.name = "label set",
          .title = "a learned marker set",
          .endings = {},
          .holds = Content::labels,
          .detail = "m; how far markers are from each other: see [labels](labels.md). For `marey label --marker-set`",
          .is =
              [](const Beginning& file) {
                return file.is_text() && file.first_line().starts_with("labels = [") && file.has("\nplaces = [");
              },
          .facts = [](const std::string& path) -> std::vector<Fact> {
            const LearnedMarkers set = read_label_set(path);
            return {{"labels", set.labels}, {"from", std::string(set.moves ? "motion" : "one who stood still")}};
          }};
}

}  // namespace marey::format::bodies
