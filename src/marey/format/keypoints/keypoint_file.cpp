#include "marey/format/keypoints/keypoint_file.h"

#include <cctype>
#include <filesystem>
#include <iterator>
#include <system_error>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/whole_file.h"
#include "marey/format/keypoints/sequence_builder.h"
#include "marey/format/read_file.h"

namespace marey::format::keypoints {
namespace {

std::string ending_of(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

void append_annotation(std::string& text, const Keypoints<2>& person, std::size_t id, std::size_t frame) {
  auto out = std::back_inserter(text);
  fmt::format_to(out, R"({}{{"id":{},"image_id":{},"category_id":1,"score":{:.4f},"keypoints":[)", id == 0 ? "" : ",\n", id + 1,
                 frame, person.presence);
  for (std::size_t i = 0; i < person.points.size(); ++i) {
    if (i > 0) text += ',';
    const auto& point = person.points[i];
    if (point) {
      fmt::format_to(out, "{:.2f},{:.2f},{:.4f}", point->position.x(), point->position.y(), point->visibility * point->presence);
    } else {
      text += "0,0,0";
    }
  }
  text += "]}";
}

}  // namespace

bool may_hold_keypoints(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    for (const auto& entry : std::filesystem::directory_iterator(path, ignored)) {
      if (entry.path().extension() == ".json") return true;
    }
    return false;
  }
  const std::string ending = ending_of(path);
  return ending == ".json" || ending == ".csv" || ending == ".jsonl";
}

KeypointSequence read_keypoints(const std::string& path, std::string_view set) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) return read_openpose_folder(path, set);
  const std::string text = read_file(path);
  if (ending_of(path) == ".jsonl") return read_keypoint_lines(text, path, set);
  return ending_of(path) == ".csv" ? read_keypoint_csv(text, path, set) : read_keypoint_json(text, path, set);
}

void write_coco_keypoints(const KeypointSequence& sequence, const std::string& path) {
  WholeFile file(path);
  std::string text = "{";
  if (sequence.rate_hz) text += fmt::format(R"("info":{{"rate_hz":{}}},)", *sequence.rate_hz);
  text += R"("categories":[{"id":1,"name":"person","keypoints":[)";
  for (std::size_t i = 0; i < sequence.set.points.size(); ++i)
    text += fmt::format("{}\"{}\"", i == 0 ? "" : ",", sequence.set.points[i]);
  text += R"(],"skeleton":[)";
  for (std::size_t i = 0; i < sequence.set.bones.size(); ++i)
    text += fmt::format("{}[{},{}]", i == 0 ? "" : ",", sequence.set.bones[i].first + 1, sequence.set.bones[i].second + 1);
  text += "]}],\n\"images\":[";
  for (std::size_t frame = 0; frame < sequence.frames.size(); ++frame) {
    text += fmt::format(R"({}{{"id":{})", frame == 0 ? "" : ",", frame);
    if (sequence.size) text += fmt::format(R"(,"width":{},"height":{})", sequence.size->width, sequence.size->height);
    text += '}';
  }
  file.write(text + "],\n\"annotations\":[\n");
  std::size_t id = 0;
  for (std::size_t frame = 0; frame < sequence.frames.size(); ++frame) {
    text.clear();
    for (const Keypoints<2>& person : sequence.frames[frame]) append_annotation(text, person, id++, frame);
    file.write(text);
  }
  file.write("\n]}\n");
  file.finish();
}

}  // namespace marey::format::keypoints
