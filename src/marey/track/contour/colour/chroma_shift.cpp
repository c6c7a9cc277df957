// The changes' magnitudes are correlated, for their signs differ from edge to edge; the peak is found to a part of a pixel by a
// parabola. Old frames fade. Cost: seven products for each pixel of chroma in the foreground, of a quarter of the rows.
#include "marey/track/contour/colour/chroma_shift.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace marey::track::contour::colour {
namespace {

constexpr int kEveryRow = 4;         // rows of chroma; numerical: cost against delay
constexpr double kFading = 0.98;     // of a frame's weight after the next; unswept
constexpr double kEnough = 600;      // pixels of foreground; unswept
constexpr double kMinPeak = 1.02;    // times the mean over all shifts; unswept
constexpr double kResolution = 2.1;  // px, standard deviation; physical: what chroma of half the resolution shows of a sharp edge
constexpr double kMaxShift = 4;      // px; physical: the reach of the correlation

}  // namespace

void ChromaShift::observe(const Image& image, const cv::Mat& foreground) {
  if (!image.is_colour() || image.luma().type() != CV_8UC1 || foreground.size() != image.size()) return;
  pixels_ *= kFading;
  for (double& one : together_) one *= kFading;
  const int rows = std::min(image.cb().rows, foreground.rows / 2);
  for (int row = next_; row < rows; row += kEveryRow) observe_row(image, foreground, row);
  next_ = (next_ + 1) % kEveryRow;
}

void ChromaShift::observe_row(const Image& image, const cv::Mat& foreground, int row) {
  const auto* taken = foreground.ptr<std::uint8_t>(2 * row);
  const auto* luma = image.luma().ptr<std::uint8_t>(2 * row);
  const auto* cb = image.cb().ptr<std::uint8_t>(row);
  const auto* cr = image.cr().ptr<std::uint8_t>(row);
  const int end = std::min(image.cb().cols, foreground.cols / 2) - kReach - 1;
  for (int x = kReach + 1; x < end; ++x) {
    if (taken[2 * x] == 0) continue;
    // Of the two pixels of luma in one of chroma, against those of its neighbours.
    const int step = std::abs(luma[2 * x + 2] + luma[2 * x + 3] - luma[2 * x - 2] - luma[2 * x - 1]);
    for (int shift = -kReach; shift <= kReach; ++shift) {
      const int at = x + shift, entry = shift + kReach;
      together_[static_cast<std::size_t>(entry)] += step * (std::abs(cb[at + 1] - cb[at - 1]) + std::abs(cr[at + 1] - cr[at - 1]));
    }
    pixels_ += 1;
  }
}

std::optional<ChromaShift::Peak> ChromaShift::peak() const {
  if (pixels_ < kEnough) return std::nullopt;
  const auto peak = std::max_element(together_.begin(), together_.end());
  const double lowest = *std::min_element(together_.begin(), together_.end());
  double mean = 0;
  for (const double one : together_) mean += one / static_cast<double>(together_.size());
  if (peak == together_.begin() || peak + 1 == together_.end() || *peak < kMinPeak * mean) return std::nullopt;
  const double bend = peak[-1] - 2 * peak[0] + peak[1];
  if (!(bend < 0)) return std::nullopt;
  return Peak{static_cast<double>(peak - together_.begin()) - kReach + (peak[-1] - peak[1]) / (2 * bend),
              std::sqrt((*peak - lowest) / -bend)};
}

double ChromaShift::px() const {
  const auto found = peak();
  return found ? std::clamp(2 * found->at, -kMaxShift, kMaxShift) : 0;
}

double ChromaShift::smear() const {
  const auto found = peak();
  return found ? std::sqrt(std::max(0.0, 4 * found->width * found->width - kResolution * kResolution)) : 0;
}

}  // namespace marey::track::contour::colour
