// A running mean for each pixel, over the frames in which it is not foreground: the plain mean of the first kMemory frames, then
// exponential. Targets' halos that the foreground misses are thus a small part of it. Fixed point, so that a row costs no division.
#include "marey/track/contour/scene_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace marey::track::contour {
namespace {

constexpr int kInterleave = 4;  // rows: one of this many is learned per frame
constexpr int kMemory = 16;     // frames of a pixel, on average; unswept
constexpr int kFixed = 128;     // units per level; numerical

constexpr std::array<int, kMemory + 1> kRates = [] {
  std::array<int, kMemory + 1> rates{};
  for (int i = 0; i <= kMemory; ++i) rates[static_cast<std::size_t>(i)] = 65536 / std::min(i + 1, kMemory);
  return rates;
}();

void learn(std::uint16_t& mean, int level, int detected) {
  const int rate = kRates[static_cast<std::size_t>(std::min(detected, kMemory))];
  mean = static_cast<std::uint16_t>(mean + (static_cast<std::int64_t>(kFixed * level - mean) * rate) / 65536);
}

cv::Mat levels(const cv::Mat& plane, const cv::Rect& area) {
  cv::Mat result;
  plane(area).convertTo(result, CV_32F, 1.0 / kFixed);
  return result;
}

}  // namespace

void SceneImage::observe(const Image& image, const cv::Mat& foreground, std::span<const Box> targets) {
  if (foreground.empty() || foreground.size() != image.size() || image.luma().type() != CV_8UC1) return;
  if (!has(image.size())) {
    const cv::Size size = image.size(), half((size.width + 1) / 2, (size.height + 1) / 2);
    frames_ = cv::Mat::zeros(size, CV_8UC1);
    luma_ = cv::Mat::zeros(size, CV_16UC1);
    cb_ = cv::Mat(half, CV_16UC1, cv::Scalar(128 * kFixed));
    cr_ = cb_.clone();
    next_ = -1;
  }
  shift_.observe(image, foreground);
  foreground.copyTo(taken_);
  const Box all{0, 0, static_cast<double>(taken_.cols), static_cast<double>(taken_.rows)};
  for (const Box& target : targets) {
    const Box part = geometry::intersection(target, all);
    if (part.empty()) continue;
    const cv::Point from(static_cast<int>(part.left), static_cast<int>(part.top)),
        to(static_cast<int>(std::ceil(part.right())), static_cast<int>(std::ceil(part.bottom())));
    taken_(cv::Rect(from, to)) = 255;
  }
  for (int row = std::max(0, next_); row < frames_.rows; row += next_ < 0 ? 1 : kInterleave) learn_row(image, taken_, row);
  next_ = (next_ + 1) % kInterleave;
}

void SceneImage::learn_row(const Image& image, const cv::Mat& scene_taken, int row) {
  const std::uint8_t* taken = scene_taken.ptr<std::uint8_t>(row);
  const std::uint8_t* level = image.luma().ptr<std::uint8_t>(row);
  std::uint8_t* frames = frames_.ptr<std::uint8_t>(row);
  std::uint16_t* mean = luma_.ptr<std::uint16_t>(row);
  // Chroma has half the rows: the even ones stand for it while all are learned, then any.
  const bool colour = image.is_colour();
  const int half = row / 2;
  for (int x = 0; x < frames_.cols; ++x) {
    if (taken[x] != 0) continue;
    const int detected = frames[x];
    learn(mean[x], level[x], detected);
    if (colour && x % 2 == 0) {
      learn(cb_.ptr<std::uint16_t>(half)[x / 2], image.cb().ptr<std::uint8_t>(half)[x / 2], detected);
      learn(cr_.ptr<std::uint16_t>(half)[x / 2], image.cr().ptr<std::uint8_t>(half)[x / 2], detected);
    }
    if (detected < 255) ++frames[x];
  }
}

cv::Mat SceneImage::luma(const cv::Rect& area) const {
  return levels(luma_, area);
}

cv::Mat SceneImage::chroma(int which, const cv::Rect& half_area) const {
  return levels(which == 0 ? cb_ : cr_, half_area);
}

cv::Mat SceneImage::known(const cv::Rect& area) const {
  cv::Mat result;
  cv::Mat(frames_(area) != 0).convertTo(result, CV_32F, 1.0 / 255);
  return result;
}

}  // namespace marey::track::contour
