#include "marey/detect/markers/marker_clutter.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace marey::detect::markers {
namespace {

constexpr double kPredominantlyCluttered = 0.4;  // of the tiles: then the rest costs less than their borders do

}  // namespace

void MarkerClutter::begin(cv::Size size, bool everywhere) {
  constexpr int kTile = MarkerThresholds::kTile;
  columns_ = (size.width + kTile - 1) / kTile;
  everywhere_ = everywhere;
  tiles_.assign(static_cast<std::size_t>(columns_) * ((size.height + kTile - 1) / kTile), everywhere ? 1 : 0);
  noise_.assign(tiles_.size(), 0);
  marked_count_ = everywhere ? static_cast<int>(tiles_.size()) : 0;
}

bool MarkerClutter::mark(int tile) {
  char& marked = tiles_[static_cast<std::size_t>(tile)];
  if (marked != 0) return false;
  marked = 1;
  fresh_ = true;
  ++marked_count_;
  return true;
}

bool MarkerClutter::mark(std::span<const MarkerRun> runs, std::span<const char> which) {
  constexpr int kTile = MarkerThresholds::kTile;
  bool fresh = false;
  for (const MarkerRun& run : runs) {
    if (which[static_cast<std::size_t>(run.parent)] == 0) continue;
    for (int x = run.begin; x < run.end; x = (x / kTile + 1) * kTile) fresh |= mark(run.row / kTile * columns_ + x / kTile);
  }
  return fresh;
}

bool MarkerClutter::mark_noise(int tile, int many) {
  return ++noise_[static_cast<std::size_t>(tile)] == many && mark(tile);
}

void MarkerClutter::clear_noise() {
  std::fill(noise_.begin(), noise_.end(), 0);
}

void MarkerClutter::forget() {
  if (everywhere_) return;
  std::fill(tiles_.begin(), tiles_.end(), 0);
  marked_count_ = 0;
}

/// The heights within an area; what is as wide as `shape` beyond it counts.
void MarkerClutter::lift(const cv::Mat& luma, const cv::Rect& area, const cv::Mat& shape) {
  const int side = shape.cols;
  const cv::Rect wider =
      cv::Rect(area.x - side, area.y - side, area.width + 2 * side, area.height + 2 * side) & cv::Rect({}, luma.size());
  cv::morphologyEx(luma(wider), lifted_, dark_ ? cv::MORPH_BLACKHAT : cv::MORPH_TOPHAT, shape);
  lifted_(area - wider.tl()).copyTo(heights_(area));
  if (dark_) {
    cv::bitwise_not(heights_(area), plane_(area));
  } else {
    heights_(area).copyTo(plane_(area));
  }
}

const cv::Mat& MarkerClutter::plane(const cv::Mat& luma, double widest) {
  constexpr int kTile = MarkerThresholds::kTile;
  const int side = 2 * static_cast<int>(std::ceil(widest / 2)) + 1;
  const cv::Mat shape = cv::Mat::ones(side, side, CV_8U);
  heights_.create(luma.size(), luma.type());
  if (!everywhere_) heights_.setTo(0);
  luma.copyTo(plane_);
  if (static_cast<double>(marked_count_) > kPredominantlyCluttered * static_cast<double>(tiles_.size())) {
    std::fill(tiles_.begin(), tiles_.end(), 1);
    marked_count_ = static_cast<int>(tiles_.size());
    lift(luma, cv::Rect({}, luma.size()), shape);
  } else {
    for (int i = 0; i < static_cast<int>(tiles_.size()); ++i) {  // neighbours in a row together
      const int row = i / columns_, first = i;
      while (i < static_cast<int>(tiles_.size()) && i / columns_ == row && tiles_[static_cast<std::size_t>(i)] != 0) ++i;
      if (i == first) continue;
      lift(luma, cv::Rect(first % columns_ * kTile, row * kTile, (i - first) * kTile, kTile) & cv::Rect({}, luma.size()), shape);
      --i;
    }
  }
  heights_levels_.learn(heights_, fresh_);
  fresh_ = false;
  return plane_;
}

const MarkerThresholds& MarkerClutter::thresholds(const MarkerLevels& image) {
  const double top = heights_.depth() == CV_8U ? 255 : 65535;
  thresholds_ = image.thresholds();
  for (int i = 0; i < static_cast<int>(tiles_.size()); ++i) {
    if (tiles_[static_cast<std::size_t>(i)] == 0) continue;
    const double demand = std::max(heights_levels_.noise_demand(i), image.demand(image.brighter_level(i)));
    const double height = std::clamp(std::floor(heights_levels_.level(i) + demand), 0.0, top);
    thresholds_.of_tile[static_cast<std::size_t>(i)] = static_cast<std::uint16_t>(dark_ ? top - height : height);
  }
  return thresholds_;
}

}  // namespace marey::detect::markers
