#include "marey/source/focal_length.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "marey/source/decoder.h"
#include "marey/source/image_sequence.h"

namespace marey::source {
namespace {

constexpr double kFrameDiagonal = 43.27;           // by definition: mm
constexpr double kMinFocal = 5, kMaxFocal = 2000;  // physical: mm; cameras write 0 where they do not know

std::optional<double> lens_of(const std::optional<std::string>& text) {
  if (!text) return std::nullopt;
  const double value = std::strtod(text->c_str(), nullptr);
  return value >= kMinFocal && value <= kMaxFocal ? std::optional(value) : std::nullopt;
}

}  // namespace

std::optional<double> focal_35mm_of(const std::string& path) {
  std::string file = path;
  if (std::filesystem::is_directory(path) || is_image_pattern(path)) {
    const auto images = find_images(path);
    if (images.empty()) return std::nullopt;
    file = images.front();
  }
  Decoder decoder(file, 1);
  if (const auto video = lens_of(decoder.tag("com.apple.quicktime.camera.focal_length.35mm_equivalent"))) return video;
  if (!is_image_name(file)) return std::nullopt;
  decoder.next();
  return lens_of(decoder.tag("FocalLengthIn35mmFilm"));
}

double focal_px_of(double focal_35mm, cv::Size image) {
  return focal_35mm / kFrameDiagonal * std::hypot(image.width, image.height);
}

}  // namespace marey::source
