#include "marey/format/pitch_points.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include <pugixml.hpp>

#include "marey/core/error.h"
#include "marey/format/read_file.h"
#include "marey/format/text_rows.h"
#include "marey/format/xml_text.h"

namespace marey::format {
namespace {

std::vector<std::string_view> parts_of(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  split_fields(text, separator, parts);
  return parts;
}

/// "a,b", with or without parentheses.
std::optional<Vector<2>> pair(std::string_view text) {
  if (text.size() >= 2 && text.front() == '(' && text.back() == ')') text = text.substr(1, text.size() - 2);
  const auto parts = parts_of(text, ',');
  if (parts.size() != 2) return std::nullopt;
  const auto x = number_of(parts[0]), y = number_of(parts[1]);
  if (!x || !y) return std::nullopt;
  return Vector<2>(*x, *y);
}

// --- CSV ---------------------------------------------------------------------------------------------------------------

constexpr std::array<std::array<std::string_view, 4>, 4> kColumnNames = {{{"x", "pitch_x", "world_x", "ground_x"},
                                                                          {"y", "pitch_y", "world_y", "ground_y"},
                                                                          {"u", "image_x", "px", "pixel_x"},
                                                                          {"v", "image_y", "py", "pixel_y"}}};

/// Where x, y, u, v stand, by the header; nothing if the line is not one.
std::optional<std::array<std::size_t, 4>> columns_of(const std::vector<std::string_view>& header) {
  std::array<std::size_t, 4> columns{};
  for (std::size_t required = 0; required < 4; ++required) {
    const auto found = std::find_if(header.begin(), header.end(), [&](std::string_view name) {
      return std::find(kColumnNames[required].begin(), kColumnNames[required].end(), name) != kColumnNames[required].end();
    });
    if (found == header.end()) return std::nullopt;
    columns[required] = static_cast<std::size_t>(found - header.begin());
  }
  return columns;
}

/// A row's frame, where there is a column for it.
std::optional<std::int64_t> frame_of(const std::vector<std::string_view>& fields, std::optional<std::size_t> column,
                                     const std::string& where) {
  if (!column) return std::nullopt;
  const auto frame = *column < fields.size() ? whole_number_of(fields[*column]) : std::nullopt;
  if (!frame || *frame < 0) throw Error("{}: its frame is not a whole number from 0 on", where);
  return frame;
}

PitchClicks parse_csv(std::string_view text, const std::string& name) {
  PitchClicks clicks;
  std::optional<std::size_t> frame_column;
  std::array<std::size_t, 4> columns = {0, 1, 2, 3};
  bool first = true;
  TextLines lines(text);
  std::string_view line;
  std::vector<std::string_view> fields;
  while (lines.next(line)) {
    if (line.empty() || line.front() == '#') continue;
    split_fields(line, line.find(',') != line.npos ? ',' : line.find(';') != line.npos ? ';' : '\t', fields);
    if (std::exchange(first, false) && !number_of(fields[0])) {
      const auto named = columns_of(fields);
      if (!named) throw Error("{}:{}: the header must name the columns x, y (m on the pitch), u, v (px)", name, lines.number());
      columns = *named;
      const auto frame = std::find(fields.begin(), fields.end(), "frame");
      if (frame != fields.end()) frame_column = static_cast<std::size_t>(frame - fields.begin());
      continue;
    }
    std::array<double, 4> values{};
    for (std::size_t i = 0; i < 4; ++i) {
      const auto value = columns[i] < fields.size() ? number_of(fields[columns[i]]) : std::nullopt;
      if (!value)
        throw Error("{}:{}: four numbers are wanted, x,y,u,v: a place on the pitch in m and its pixel", name, lines.number());
      values[i] = *value;
    }
    clicks.points.push_back({{values[0], values[1]},
                             {values[2], values[3]},
                             fmt::format("({:g},{:g})", values[0], values[1]),
                             frame_of(fields, frame_column, fmt::format("{}:{}", name, lines.number()))});
  }
  return clicks;
}

// --- CVAT ----------------------------------------------------------------------------------------------------------------

/// Continuous coordinates from the top left corner of the image to ours, whose integers are pixel centres.
std::optional<std::vector<Vector<2>>> cvat_pixels(std::string_view text) {
  std::vector<Vector<2>> pixels;
  for (const std::string_view one : parts_of(text, ';')) {
    const auto pixel = pair(one);
    if (!pixel) return std::nullopt;
    pixels.push_back(pixel->array() - 0.5);
  }
  return pixels;
}

PitchClicks parse_cvat(std::string_view text, const std::string& name) {
  const pugi::xml_document document = parse_xml(text, name);
  PitchClicks clicks;
  const auto images = document.select_nodes("//image");
  if (images.empty()) throw Error("{}: no <image> in it; export the task as \"CVAT for images\"", name);
  for (const auto& image : images) {
    for (const pugi::xml_node node : image.node().children()) {
      const std::string_view kind = node.name(), label = node.attribute("label").value();
      if (kind != "points" && kind != "polyline") continue;
      const auto pixels = cvat_pixels(node.attribute("points").value());
      if (!pixels) throw Error("{}: <{} label={}>: its points are not numbers", name, kind, shown(label));
      if (kind == "points") {
        const auto ground = pair(label);
        if (!ground) throw Error("{}: the label {} is not a place on the pitch; it must read (x,y), in m", name, shown(label));
        const auto frame = whole_number_of(image.node().attribute("id").value());
        for (const Vector<2>& pixel : *pixels) clicks.points.push_back({*ground, pixel, std::string(label), frame});
        continue;
      }
      const auto middle = label.find(")-(");
      const auto from = middle == std::string_view::npos ? std::nullopt : pair(label.substr(0, middle + 1));
      const auto to = middle == std::string_view::npos ? std::nullopt : pair(label.substr(middle + 2));
      if (!from || !to || (*from - *to).norm() < 1e-6)
        throw Error("{}: the label {} is not a line of the pitch; it must read (x,y)-(x,y), in m", name, shown(label));
      clicks.lines.push_back({*from, *to, *pixels, std::string(label)});
    }
  }
  return clicks;
}

bool is_xml(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  return begin != text.npos && text[begin] == '<';
}

}  // namespace

PitchClicks parse_pitch_clicks(std::string_view text, const std::string& name) {
  PitchClicks clicks = is_xml(text) ? parse_cvat(text, name) : parse_csv(text, name);
  if (clicks.points.empty() && clicks.lines.empty()) throw Error("{}: not one point of the pitch is in it", name);
  return clicks;
}

PitchClicks read_pitch_clicks(const std::string& path) {
  return parse_pitch_clicks(read_file(path), path);
}

}  // namespace marey::format
