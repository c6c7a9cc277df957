#include "marey/source/open_source.h"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "marey/source/image_sequence.h"
#include "marey/source/video_source.h"

namespace marey::source {

std::unique_ptr<Source> open_source(const std::string& path, std::optional<double> rate_hz) {
  std::error_code error;
  const bool exists = std::filesystem::exists(path, error);
  if (std::filesystem::is_directory(path, error)) {
    std::vector<std::string> files = find_images(path);
    require_sequence(path, files);
    return open_images(path, std::move(files), rate_hz);
  }
  if (!exists && is_image_pattern(path)) return open_images(path, find_images(path), rate_hz);
  if (exists && is_image_name(path)) return open_images(path, {path}, rate_hz);
  return open_video(path, rate_hz);
}

}  // namespace marey::source
