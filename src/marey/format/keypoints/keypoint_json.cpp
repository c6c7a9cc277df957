// The JSON forms. OpenPose: a file a frame, {"people": [{"pose_keypoints_2d": [x, y, confidence, …]}]}. COCO results and AlphaPose:
// a list of {"image_id", "keypoints": [x, y, confidence, …], "score"}, image_id a number or a file's name. COCO annotations:
// {"images", "annotations", "categories": [{"keypoints": [names]}]}. MMPose: {"meta_info", "instance_info": [{"frame_id",
// "instances":
// [{"keypoints": [[x, y], …], "keypoint_scores": […]}]}]}.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "marey/core/error.h"
#include "marey/files/natural_order.h"
#include "marey/format/keypoints/sequence_builder.h"
#include "marey/format/nesting.h"
#include "marey/format/read_file.h"

namespace marey::format::keypoints {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

json parse_keypoint_json(std::string_view text, const std::string& path) {
  check_nesting(text, Notation::json, path);
  try {
    return json::parse(text);
  } catch (const json::parse_error& error) {
    if (error.byte > 0 && text.substr(std::min(error.byte - 1, text.size()), 3) == "NaN")
      throw Error("{}: NaN at byte {} is no number of JSON; a missing point has null or the confidence 0", path, error.byte);
    throw Error("{}: is not JSON: it breaks off or is wrong at byte {}", path, error.byte);
  }
}

double number_or_zero(const json& value, const std::string& where) {
  if (value.is_null()) return 0;
  if (!value.is_number()) throw Error("{}: a keypoint is no number", where);
  return value.get<double>();
}

/// x, y, confidence, x, …
std::vector<FilePoint> points_of_triples(const json& list, const std::string& where) {
  if (!list.is_array() || list.size() % 3 != 0)
    throw Error("{}: keypoints must be a list of x, y, confidence for each point", where);
  std::vector<FilePoint> points(list.size() / 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool missing = list[3 * i].is_null() || list[3 * i + 1].is_null();
    points[i] = {number_or_zero(list[3 * i], where), number_or_zero(list[3 * i + 1], where),
                 missing ? 0 : number_or_zero(list[3 * i + 2], where)};
  }
  return points;
}

void add_openpose(const json& root, std::int64_t frame, SequenceBuilder& builder, const std::string& path) {
  const auto people = root.is_object() ? root.find("people") : root.end();
  if (!root.is_object() || people == root.end() || !people->is_array())
    throw Error("{}: is not a file of OpenPose: \"people\" is missing", path);
  builder.add_frame(frame);
  for (const json& person : *people) {
    const auto points = person.find("pose_keypoints_2d");
    if (points == person.end()) throw Error("{}: a person without \"pose_keypoints_2d\"", path);
    builder.add(frame, points_of_triples(*points, path), 1, path);
  }
}

std::int64_t frame_of(const json& id, const std::string& where) {
  if (id.is_number_integer()) return id.get<std::int64_t>();
  const std::int64_t number = id.is_string() ? frame_number_in(fs::path(id.get<std::string>()).stem().string()) : -1;
  if (number < 0) throw Error("{}: an image_id tells no frame; it must be a number or a name with one", where);
  return number;
}

/// Which frame each image is: by growing number in its name, else by its id.
std::map<std::int64_t, std::int64_t> frames_of_images(const json& images, SequenceBuilder& builder, const std::string& path) {
  std::vector<std::pair<std::int64_t, std::int64_t>> by_number;  // number, id
  std::set<std::int64_t> numbers;
  for (const json& image : images) {
    const std::int64_t id = frame_of(image.value("id", json()), path);
    const std::int64_t named = frame_number_in(fs::path(image.value("file_name", "")).stem().string());
    by_number.emplace_back(named >= 0 ? named : id, id);
    numbers.insert(by_number.back().first);
    const int width = image.value("width", 0), height = image.value("height", 0);
    if (width > 0 && height > 0) builder.sequence().size = cv::Size(width, height);
  }
  const bool by_name = numbers.size() == by_number.size();
  std::map<std::int64_t, std::int64_t> frames;
  for (const auto& [number, id] : by_number) {
    const std::int64_t frame = by_name ? number : id;
    if (!frames.emplace(id, frame).second) throw Error("{}: two images have the id {}", path, id);
    builder.add_frame(frame);
  }
  return frames;
}

void add_annotations(const json& root, SequenceBuilder& builder, const std::string& path) {
  const json& annotations = root.at("annotations");
  if (!annotations.is_array()) throw Error("{}: \"annotations\" must be a list", path);
  for (const json& category : root.value("categories", json::array())) {
    if (category.contains("keypoints")) {
      builder.name_points(category.at("keypoints").get<std::vector<std::string>>());
      break;
    }
  }
  if (root.contains("info") && root.at("info").is_object() && root.at("info").contains("rate_hz"))
    builder.sequence().rate_hz = root.at("info").at("rate_hz").get<double>();
  const auto frames = frames_of_images(root.value("images", json::array()), builder, path);
  for (const json& one : annotations) {
    if (!one.contains("keypoints") || !one.contains("image_id")) continue;
    const std::int64_t id = frame_of(one.at("image_id"), path);
    const auto frame = frames.find(id);
    const std::vector<FilePoint> points = points_of_triples(one.at("keypoints"), fmt::format("{}: image {}", path, id));
    builder.add(frame == frames.end() ? id : frame->second, points, one.value("score", 1.0), fmt::format("{}: image {}", path, id));
  }
}

/// COCO's results and AlphaPose's, whose confidences are not probabilities: they may exceed 1.
void add_results(const json& root, SequenceBuilder& builder, const std::string& path) {
  for (const json& one : root) {
    if (!one.is_object() || !one.contains("keypoints") || !one.contains("image_id"))
      throw Error("{}: a result without \"image_id\" or \"keypoints\"", path);
    const std::int64_t frame = frame_of(one.at("image_id"), path);
    const std::string where = fmt::format("{}: image {}", path, frame);
    builder.add(frame, points_of_triples(one.at("keypoints"), where), one.value("score", 1.0), where);
  }
}

std::vector<FilePoint> points_of_instance(const json& instance, const std::string& where) {
  const json &locations = instance.at("keypoints"), &scores = instance.at("keypoint_scores");
  if (!locations.is_array() || !scores.is_array() || locations.size() != scores.size())
    throw Error("{}: \"keypoints\" and \"keypoint_scores\" must be lists of one length", where);
  std::vector<FilePoint> points(locations.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!locations[i].is_array() || locations[i].size() < 2) throw Error("{}: a keypoint must be [x, y]", where);
    points[i] = {number_or_zero(locations[i][0], where), number_or_zero(locations[i][1], where), number_or_zero(scores[i], where)};
  }
  return points;
}

void add_instances(const json& root, SequenceBuilder& builder, const std::string& path) {
  const json meta = root.value("meta_info", json::object());
  if (meta.contains("keypoint_id2name")) {
    std::map<int, std::string> names;
    for (const auto& [id, name] : meta.at("keypoint_id2name").items())
      names[static_cast<int>(frame_number_in(id))] = name.get<std::string>();
    std::vector<std::string> ordered;
    for (const auto& [id, name] : names) ordered.push_back(name);
    builder.name_points(ordered);
  }
  for (const json& frame : root.at("instance_info")) {
    const std::int64_t number = frame_of(frame.value("frame_id", json()), path);
    builder.add_frame(number);
    for (const json& instance : frame.at("instances")) {
      const std::string where = fmt::format("{}: frame {}", path, number);
      double score = 1;
      if (const auto box = instance.find("bbox_score"); box != instance.end() && box->is_number()) score = box->get<double>();
      builder.add(number, points_of_instance(instance, where), score, where);
    }
  }
}

}  // namespace

KeypointSequence read_openpose_folder(const std::string& path, std::string_view set) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(path, error)) {
    if (entry.path().extension() == ".json") names.push_back(entry.path().filename().string());
  }
  if (error) throw Error("{}: cannot be read: {}", path, error.message());
  if (names.empty()) throw Error("{}: holds no .json file; OpenPose writes one a frame", path);
  std::sort(names.begin(), names.end(), NaturalOrder());
  SequenceBuilder builder(path);
  std::set<std::int64_t> numbers;
  for (const std::string& name : names) numbers.insert(frame_number_in(fs::path(name).stem().string()));
  const bool numbered = numbers.size() == names.size() && *numbers.begin() >= 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string file = (fs::path(path) / names[i]).string();
    const std::int64_t frame = numbered ? frame_number_in(fs::path(names[i]).stem().string()) : static_cast<std::int64_t>(i);
    add_openpose(parse_keypoint_json(read_file(file), file), frame, builder, file);
  }
  return builder.finish(set);
}

KeypointSequence read_keypoint_json(std::string_view text, const std::string& path, std::string_view set) {
  const json root = parse_keypoint_json(text, path);
  SequenceBuilder builder(path);
  try {
    if (root.is_array()) {
      add_results(root, builder, path);
    } else if (root.is_object() && root.contains("annotations")) {
      add_annotations(root, builder, path);
    } else if (root.is_object() && root.contains("instance_info")) {
      add_instances(root, builder, path);
    } else if (root.is_object() && root.contains("people")) {
      add_openpose(root, std::max<std::int64_t>(0, frame_number_in(fs::path(path).stem().string())), builder, path);
    } else {
      throw Error("{}: holds no keypoints of OpenPose, COCO, AlphaPose or MMPose", path);
    }
  } catch (const json::exception& error) {
    throw Error("{}: a field of its keypoints is missing or of another kind ({})", path, error.what());
  }
  return builder.finish(set);
}

}  // namespace marey::format::keypoints
