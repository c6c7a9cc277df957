#include "marey/format/pitch_labels.h"

#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "marey/core/error.h"
#include "marey/core/text_safety.h"
#include "marey/format/nesting.h"
#include "marey/format/read_file.h"

namespace marey::format {
namespace {

using nlohmann::json;

constexpr double kFarthestShare = 3;  // beyond, a coordinate is no share of a picture but a pixel

double share_of(const json& point, const char* axis, const std::string& where) {
  const auto value = point.find(axis);
  if (value == point.end() || !value->is_number() || !(std::abs(value->get<double>()) <= kFarthestShare))
    throw Error("{}: a point's \"{}\" must be a number, a share of the picture between 0 and 1", where, axis);
  return value->get<double>();
}

LabelledPicture picture_of(const json& labels, const std::string& name, const std::string& where, cv::Size size) {
  LabelledPicture picture;
  picture.name = name;
  for (const auto& [label, points] : labels.items()) {
    const std::string here = fmt::format("{}: element \"{}\"", where, plain_text(label));
    if (!points.is_array()) throw Error("{}: must be a list of points", here);
    if (label == "Line unknown" || label == "Goal unknown") continue;
    const auto element = geometry::pitch_element_named(label);
    if (!element) throw Error("{}: is no element of a pitch; the names are those of SoccerNet's camera calibration", here);
    geometry::LabelledElement labelled{*element, {}};
    for (const json& point : points) {
      if (!point.is_object()) throw Error("{}: a point must be an object with \"x\" and \"y\"", here);
      labelled.points.emplace_back(share_of(point, "x", here) * (size.width - 1), share_of(point, "y", here) * (size.height - 1));
    }
    if (!labelled.points.empty()) picture.elements.push_back(std::move(labelled));
  }
  return picture;
}

}  // namespace

std::vector<LabelledPicture> parse_pitch_labels(std::string_view text, const std::string& name, cv::Size size) {
  check_nesting(text, Notation::json, name);
  json root;
  try {
    root = json::parse(text);
  } catch (const json::parse_error& error) {
    throw Error("{}: is no JSON: it breaks off or is wrong at byte {}", name, error.byte);
  }
  if (!root.is_object()) throw Error("{}: is no labels of a pitch: it must be an object of elements by name", name);
  std::vector<LabelledPicture> pictures;
  const bool many = !root.empty() && root.begin()->is_object();
  if (!many) return {picture_of(root, std::filesystem::path(name).stem().string(), name, size)};
  for (const auto& [picture, labels] : root.items()) {
    const std::string where = fmt::format("{}: picture \"{}\"", name, plain_text(picture));
    if (!labels.is_object()) throw Error("{}: must be an object of elements by name", where);
    pictures.push_back(picture_of(labels, plain_text(picture), where, size));
  }
  return pictures;
}

std::vector<LabelledPicture> read_pitch_labels(const std::string& path, cv::Size size) {
  return parse_pitch_labels(read_file(path), path, size);
}

}  // namespace marey::format
