#include "marey/detect/keypoints/model_folder.h"

#include <cstdlib>
#include <filesystem>
#include <vector>

#include <dlfcn.h>
#include <fmt/format.h>

#include "marey/core/error.h"

namespace marey::detect::keypoints {
namespace {

constexpr int kAbove = 6;  // folders

/// The library that this code is in, if it is in one, and the program.
std::vector<std::filesystem::path> own_files() {
  std::vector<std::filesystem::path> files;
  std::error_code failed;
  Dl_info info{};
  // Of a program the loader knows the name that it was called by alone, which may be another file's.
  if (dladdr(reinterpret_cast<const void*>(&own_files), &info) != 0 && info.dli_fname != nullptr)
    files.push_back(std::filesystem::canonical(info.dli_fname, failed));
  files.push_back(std::filesystem::canonical("/proc/self/exe", failed));
  return files;
}

std::vector<std::filesystem::path> model_folders() {
  if (const char* given = std::getenv("MAREY_MODELS"); given != nullptr && *given != '\0') return {given};
  std::vector<std::filesystem::path> folders;
  for (const std::filesystem::path& file : own_files()) {
    std::filesystem::path folder = file.parent_path();
    for (int i = 0; i < kAbove && folder.has_relative_path(); ++i, folder = folder.parent_path()) {
      folders.push_back(folder / "models");
      folders.push_back(folder / "share/marey/models");
    }
  }
  return folders;
}

}  // namespace

std::string model_file(std::string_view name) {
  for (const std::filesystem::path& folder : model_folders()) {
    if (std::filesystem::is_regular_file(folder / name)) return (folder / name).string();
  }
  if (name.find("heavy") != std::string_view::npos)
    throw Error(
        "the network {} is not there: it is in no package; script/model --heavy of Marey's sources makes it, and MAREY_MODELS "
        "names "
        "the folder that it is in",
        name);
  throw Error("the network {} is not there; script/model makes it (or install marey-models; MAREY_MODELS names another folder)",
              name);
}

std::string landmark_model(std::string_view name) {
  if (name.ends_with(".onnx")) return std::string(name);
  return model_file(fmt::format("pose_landmark_{}.onnx", name));
}

}  // namespace marey::detect::keypoints
