// A running mean for each pixel, over the frames in which it is not foreground: the plain mean of the first kMemory frames, then
// exponential. Targets' halos that the foreground misses are thus a small part of it. Fixed point, so that a row costs no division.
// Neighbours were mostly learned from as many frames: they are learned together, at one rate.
#include "marey/track/contour/colour/scene_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

namespace marey::track::contour::colour {
namespace {

constexpr int kInterleave = 4;  // rows: one of this many is learned per frame
constexpr int kMemory = 16;     // frames of a pixel, on average; unswept
constexpr int kFixed = 128;     // units per level; numerical
constexpr int kBlock = 32;      // px that are learned alike; even; numerical

constexpr std::array<int, kMemory + 1> kRates = [] {
  std::array<int, kMemory + 1> rates{};
  for (int i = 0; i <= kMemory; ++i) rates[static_cast<std::size_t>(i)] = 65536 / std::min(i + 1, kMemory);
  return rates;
}();

void learn(std::uint16_t& mean, int level, int detected) {
  const int rate = kRates[static_cast<std::size_t>(std::min(detected, kMemory))];
  mean = static_cast<std::uint16_t>(mean + (static_cast<std::int64_t>(kFixed * level - mean) * rate) / 65536);
}

/// `learn` of `count` pixels that were all learned from as many frames, or all from kMemory and more.
void learn_alike(std::uint16_t* mean, const std::uint8_t* level, int count, int detected) {
  const int rate = kRates[static_cast<std::size_t>(std::min(detected, kMemory))];
  if (detected >= kMemory) {  // the rate is 65536 / kMemory
    for (int x = 0; x < count; ++x) mean[x] = static_cast<std::uint16_t>(mean[x] + (kFixed * level[x] - mean[x]) / kMemory);
  } else if (detected == 0) {  // it is 65536
    for (int x = 0; x < count; ++x) mean[x] = static_cast<std::uint16_t>(kFixed * level[x]);
  } else {
    for (int x = 0; x < count; ++x) mean[x] = static_cast<std::uint16_t>(mean[x] + (kFixed * level[x] - mean[x]) * rate / 65536);
  }
}

/// Of how many frames all pixels of a block were learned, kMemory for any more; nothing if they differ or one is taken.
std::optional<int> frames_of_all(const std::uint8_t* taken, const std::uint8_t* frames, int count) {
  std::uint8_t any = 0, fewest = 255, most = 0;
  for (int x = 0; x < count; ++x) {
    any = static_cast<std::uint8_t>(any | taken[x]);
    fewest = std::min(fewest, frames[x]);
    most = std::max(most, frames[x]);
  }
  if (any != 0 || (fewest < kMemory && fewest != most)) return std::nullopt;
  return std::min<int>(fewest, kMemory);
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
  for (int row = std::max(0, next_); row < frames_.rows; row += next_ < 0 ? 1 : kInterleave) {
    note_taken(foreground, targets, row);
    learn_row(image, row);
  }
  next_ = (next_ + 1) % kInterleave;
}

void SceneImage::note_taken(const cv::Mat& foreground, std::span<const Box> targets, int row) {
  const std::uint8_t* from = foreground.ptr<std::uint8_t>(row);
  taken_.assign(from, from + foreground.cols);
  const Box all{0, 0, static_cast<double>(foreground.cols), static_cast<double>(foreground.rows)};
  for (const Box& target : targets) {
    const Box part = geometry::intersection(target, all);
    if (part.empty() || row < static_cast<int>(part.top) || row >= static_cast<int>(std::ceil(part.bottom()))) continue;
    std::fill(taken_.begin() + static_cast<int>(part.left), taken_.begin() + static_cast<int>(std::ceil(part.right())),
              std::uint8_t{255});
  }
}

void SceneImage::learn_row(const Image& image, int row) {
  for (int x = 0; x < frames_.cols; x += kBlock) learn_block(image, row, x, std::min(kBlock, frames_.cols - x));
}

void SceneImage::learn_block(const Image& image, int row, int first, int count) {
  const std::uint8_t* taken = taken_.data() + first;
  const std::uint8_t* level = image.luma().ptr<std::uint8_t>(row) + first;
  std::uint8_t* frames = frames_.ptr<std::uint8_t>(row) + first;
  std::uint16_t* mean = luma_.ptr<std::uint16_t>(row) + first;
  // Chroma has half the rows: the even ones stand for it while all are learned, then any.
  const bool colour = image.is_colour();
  const int half = row / 2;
  const std::optional<int> alike = frames_of_all(taken, frames, count);
  if (alike) {
    learn_alike(mean, level, count, *alike);
    for (int x = 0; x < count; ++x) frames[x] = static_cast<std::uint8_t>(frames[x] + (frames[x] < 255 ? 1 : 0));
  }
  std::uint16_t* means[2]{cb_.ptr<std::uint16_t>(half) + first / 2, cr_.ptr<std::uint16_t>(half) + first / 2};
  const std::uint8_t* chroma[2]{};
  for (int i = 0; i < 2 && colour; ++i) {
    chroma[i] = (i == 0 ? image.cb() : image.cr()).ptr<std::uint8_t>(half) + first / 2;
    if (alike) learn_alike(means[i], chroma[i], (count + 1) / 2, *alike);
  }
  for (int x = 0; x < count && !alike; ++x) {
    if (taken[x] != 0) continue;
    const int detected = frames[x];
    learn(mean[x], level[x], detected);
    for (int i = 0; i < 2 && colour && x % 2 == 0; ++i) learn(means[i][x / 2], chroma[i][x / 2], detected);
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

}  // namespace marey::track::contour::colour
