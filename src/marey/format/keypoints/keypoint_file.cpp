#include "marey/format/keypoints/keypoint_file.h"

#include <cctype>
#include <filesystem>
#include <system_error>

#include "marey/format/keypoints/sequence_builder.h"
#include "marey/format/read_file.h"

namespace marey::format::keypoints {
namespace {

std::string ending_of(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
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

}  // namespace marey::format::keypoints
