#include "marey/format/bodies/body_file.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/files/text_safety.h"
#include "marey/files/whole_file.h"
#include "marey/format/format.h"
#include "marey/format/motion/marker_set.h"
#include "marey/format/nesting.h"
#include "marey/format/read_file.h"
#include "marey/format/rig/rig_section.h"

namespace marey::format::bodies {
namespace {

constexpr std::size_t kMaxMarkers = 1000;  // of a body

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : plain_text(text)) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

BodyMarker read_body_marker(const toml::table& table, const std::string& body, rig::Problems& problems) {
  rig::Section section(table, fmt::format("a marker of body \"{}\"", body), problems);
  section.only({"label", "position"});
  BodyMarker marker;
  marker.label = plain_text(section.text("label").value_or(""));
  if (marker.label.empty()) section.problem("label", "has no label; give it the name that the marker bears in recordings");
  if (!section.has("position")) section.problem("position", "has no position; give [x, y, z] in m, in the body's frame");
  const auto position = section.numbers("position", 3, 3, "three numbers, m");
  if (position) marker.position = {(*position)[0], (*position)[1], (*position)[2]};
  return marker;
}

Body read_body(const toml::table& table, int number, rig::Problems& problems) {
  rig::Section section(table, fmt::format("body {}", number), problems);
  section.only({"name", "marker"});
  Body body;
  body.id = BodyId{number};
  body.label = plain_text(section.text("name").value_or(""));
  if (body.label.empty()) section.problem("name", "has no name; give it one");
  const toml::array* markers = table["marker"].as_array();
  if (markers == nullptr || markers->size() < 3 || markers->size() > kMaxMarkers) {
    section.problem("marker", fmt::format("needs three [[body.marker]] or more, and at most {}", kMaxMarkers));
    return body;
  }
  std::set<std::string> labels;
  for (const toml::node& node : *markers) {
    const toml::table* marker = node.as_table();
    if (marker == nullptr) {
      problems.add(node.source(), "a marker is a table; write [[body.marker]] before it");
      continue;
    }
    body.markers.push_back(read_body_marker(*marker, body.label, problems));
    if (!labels.insert(body.markers.back().label).second)
      problems.add(node.source(), fmt::format("body \"{}\" has the marker \"{}\" twice", body.label, body.markers.back().label));
  }
  return body;
}

}  // namespace

std::vector<Body> parse_bodies(std::string_view text, const std::string& name) {
  check_nesting(text, Notation::toml, name);
  toml::table file;
  try {
    file = toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    throw Error("{}:{}: {}", name, std::max<unsigned>(1, error.source().begin.line), rig::excerpt(error.description(), 200));
  }
  rig::Problems problems(name);
  std::vector<Body> bodies;
  std::set<std::string> names;
  for (const auto& [key, value] : file) {
    const toml::array* tables = value.as_array();
    if (key != "body" || tables == nullptr) {
      problems.add(key.source(), fmt::format("unknown key \"{}\"; there is [[body]]", rig::excerpt(key.str())));
      continue;
    }
    for (const toml::node& node : *tables) {
      const toml::table* table = node.as_table();
      if (table == nullptr) {
        problems.add(node.source(), "a body is a table; write [[body]] before it");
        continue;
      }
      bodies.push_back(read_body(*table, static_cast<int>(bodies.size()) + 1, problems));
      if (!names.insert(bodies.back().label).second)
        problems.add(node.source(), fmt::format("another body is called \"{}\"; each needs its own name", bodies.back().label));
    }
  }
  if (bodies.empty()) problems.add({}, "there is no body; add a [[body]] for each");
  problems.throw_if_any();
  return bodies;
}

std::vector<Body> read_bodies(const std::string& path) {
  const Beginning beginning = beginning_of(path);
  if (beginning.first_line() != "label,x,y,z") return parse_bodies(read_file(path), path);
  const MarkerSet set = motion::read_marker_set(path);
  Body body;
  body.id = BodyId{1};
  body.label = std::filesystem::path(path).stem().string();
  for (std::size_t m = 0; m < set.labels.size(); ++m) body.markers.push_back({set.labels[m], set.locations[m]});
  return {body};
}

std::string bodies_text(const std::vector<Body>& bodies, const std::vector<std::vector<std::string>>& notes) {
  std::string text;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (b > 0) text += '\n';
    if (b < notes.size()) {
      for (const std::string& note : notes[b]) text += fmt::format("# {}\n", plain_text(note));
    }
    text += fmt::format("[[body]]\nname = {}\n", quoted(bodies[b].label));
    for (const BodyMarker& marker : bodies[b].markers)
      text += fmt::format("[[body.marker]]\nlabel = {}\nposition = [{:.7f}, {:.7f}, {:.7f}]\n", quoted(marker.label),
                          marker.position.x(), marker.position.y(), marker.position.z());
  }
  return text;
}

void write_bodies(const std::string& path, const std::vector<Body>& bodies, const std::vector<std::vector<std::string>>& notes) {
  WholeFile file(path);
  file.write(bodies_text(bodies, notes));
  file.finish();
}

Format bodies_format() {
  return {.name = "bodies",
          .title = "rigid bodies",
          .endings = {},
          .holds = Content::labels,
          .detail = "m; each body's markers in its own frame: see [bodies](bodies.md)",
          .is = [](const Beginning& file) { return file.is_text() && file.has("[[body]]"); },
          .facts = [](const std::string& path) -> std::vector<Fact> {
            std::vector<std::string> names;
            std::int64_t markers = 0;
            for (const Body& body : read_bodies(path)) {
              names.push_back(body.label);
              markers += std::ssize(body.markers);
            }
            return {{"bodies", names}, {"markers", markers}};
          }};
}

}  // namespace marey::format::bodies
