#include "marey/format/pitch_labels.h"

#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "marey/core/error.h"
#include "marey/files/text_safety.h"
#include "marey/format/nesting.h"
#include "marey/format/read_file.h"

namespace marey::format {
namespace {

using nlohmann::json;

constexpr double kMaxFraction = 3;  // beyond, a coordinate is not a share of an image but a pixel

double fraction_of(const json& point, const char* axis, const std::string& where) {
  const auto value = point.find(axis);
  if (value == point.end() || !value->is_number() || !(std::abs(value->get<double>()) <= kMaxFraction))
    throw Error("{}: a point's \"{}\" must be a number, a share of the image between 0 and 1", where, axis);
  return value->get<double>();
}

LabelledImage image_of(const json& labels, const std::string& name, const std::string& where, cv::Size size) {
  LabelledImage image;
  image.name = name;
  for (const auto& [label, points] : labels.items()) {
    const std::string here = fmt::format("{}: element \"{}\"", where, plain_text(label));
    if (!points.is_array()) throw Error("{}: must be a list of points", here);
    if (label == "Line unknown" || label == "Goal unknown") continue;
    const auto element = geometry::pitch_element_named(label);
    if (!element) throw Error("{}: is not an element of a pitch; the names are those of SoccerNet's camera calibration", here);
    geometry::LabelledElement labelled{*element, {}};
    for (const json& point : points) {
      if (!point.is_object()) throw Error("{}: a point must be an object with \"x\" and \"y\"", here);
      labelled.points.emplace_back(fraction_of(point, "x", here) * (size.width - 1),
                                   fraction_of(point, "y", here) * (size.height - 1));
    }
    if (!labelled.points.empty()) image.elements.push_back(std::move(labelled));
  }
  return image;
}

}  // namespace

std::vector<LabelledImage> parse_pitch_labels(std::string_view text, const std::string& name, cv::Size size) {
  check_nesting(text, Notation::json, name);
  json root;
  try {
    root = json::parse(text);
  } catch (const json::parse_error& error) {
    throw Error("{}: is not JSON: it breaks off or is wrong at byte {}", name, error.byte);
  }
  if (!root.is_object()) throw Error("{}: does not hold labels of a pitch: it must be an object of elements by name", name);
  std::vector<LabelledImage> images;
  const bool many = !root.empty() && root.begin()->is_object();
  if (!many) return {image_of(root, std::filesystem::path(name).stem().string(), name, size)};
  for (const auto& [image, labels] : root.items()) {
    const std::string where = fmt::format("{}: image \"{}\"", name, plain_text(image));
    if (!labels.is_object()) throw Error("{}: must be an object of elements by name", where);
    images.push_back(image_of(labels, plain_text(image), where, size));
  }
  return images;
}

std::vector<LabelledImage> read_pitch_labels(const std::string& path, cv::Size size) {
  return parse_pitch_labels(read_file(path), path, size);
}

}  // namespace marey::format
