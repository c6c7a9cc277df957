#include "marey/draw/mask_folder.h"

#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/image.h"
#include "marey/draw/image_file.h"

namespace marey::draw {

std::string MaskFolder::path_of(std::int64_t index) const {
  return (std::filesystem::path(folder_) / fmt::format("{}{:06}.png", prefix_, index + 1)).string();
}

MaskFolder::MaskFolder(std::string folder, std::string prefix) : folder_(std::move(folder)), prefix_(std::move(prefix)) {
  std::error_code problem;
  made_ = std::filesystem::create_directories(folder_, problem);
  if (problem) throw Error("{}: cannot be made a folder for masks", folder_);
  require_free(folder_);
}

void MaskFolder::require_free(const std::string& folder) {
  std::error_code problem;
  if (!std::filesystem::exists(folder, problem)) return;
  if (!std::filesystem::is_directory(folder, problem)) throw Error("{}: cannot be made a folder for masks", folder);
  if (!std::filesystem::is_empty(folder, problem) || problem)
    throw Error("{}: is not empty; masks go into a folder of their own", folder);
}

MaskFolder::~MaskFolder() {
  if (finished_) return;
  std::error_code ignored;
  for (const std::int64_t index : written_) std::filesystem::remove(path_of(index), ignored);
  if (made_) std::filesystem::remove(folder_, ignored);  // only where it is empty
}

void MaskFolder::add(std::int64_t index, const cv::Mat& mask, cv::Size size) {
  const Image image(mask.empty() ? cv::Mat(size, CV_8UC1, cv::Scalar(0)) : mask);
  write_image(path_of(index), image);
  written_.push_back(index);
}

}  // namespace marey::draw
