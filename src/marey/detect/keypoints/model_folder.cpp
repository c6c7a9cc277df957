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

/// The program or library that this code is in.
std::filesystem::path own_file() {
  Dl_info info{};
  std::error_code failed;
  if (dladdr(reinterpret_cast<const void*>(&own_file), &info) != 0 && info.dli_fname != nullptr) {
    const auto file = std::filesystem::canonical(info.dli_fname, failed);
    if (!failed) return file;
  }
  return std::filesystem::canonical("/proc/self/exe", failed);
}

std::vector<std::filesystem::path> model_folders() {
  if (const char* given = std::getenv("MAREY_MODELS"); given != nullptr && *given != '\0') return {given};
  std::vector<std::filesystem::path> folders;
  std::filesystem::path folder = own_file().parent_path();
  for (int i = 0; i < kAbove && folder.has_relative_path(); ++i, folder = folder.parent_path()) {
    folders.push_back(folder / "models");
    folders.push_back(folder / "share/marey/models");
  }
  return folders;
}

}  // namespace

std::string model_file(std::string_view name) {
  for (const std::filesystem::path& folder : model_folders()) {
    if (std::filesystem::is_regular_file(folder / name)) return (folder / name).string();
  }
  throw Error("the network {} is not there; script/model makes it (or install marey-models; MAREY_MODELS names another folder)",
              name);
}

std::string landmark_model(std::string_view name) {
  if (name.ends_with(".onnx")) return std::string(name);
  return model_file(fmt::format("pose_landmark_{}.onnx", name));
}

}  // namespace marey::detect::keypoints
