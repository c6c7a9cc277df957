// A change of light multiplies what every pixel receives, and in gamma-coded video too what is stored: frame ≈ gain · scene. On a
// sparse grid of about two thousand pixels the ratios frame / scene are taken; the median ratio of each of 6 × 4 cells is the
// cell's gain, which people do not disturb while they fill less than half of it. A cell counts only where most of its ratios
// agree with its median, and is then outvoted by its neighbours through a 3 × 3 median, so that a person who fills a cell is not
// taken for light. Changes that are small compared with the thresholds are left to the model's own learning.
#include "marey/detect/background/background_light.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "marey/geometry/median.h"

namespace marey::detect::background {
namespace {

constexpr double kSamples = 2000;
constexpr int kDarkest = 24;     // levels over black: darker ones give little of a ratio
constexpr int kBrightest = 235;  // brighter ones may be clipped
constexpr float kNoticeable = 0.03F;
constexpr float kMaxMagnitude = 2.5F;  // beyond, and below its inverse, something covers the camera or its scene is another
constexpr std::size_t kMinRatios = 12;

}  // namespace

void LightMeter::sample(const cv::Mat& luma, const ScenePlane& scene, int black) {
  for (Cell& cell : cells_) cell.ratios.clear();
  all_.clear();
  const int step = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(luma.total()) / kSamples)));
  for (int y = step / 2; y < luma.rows; y += step) {
    for (int x = step / 2; x < luma.cols; x += step) {
      const int was = scene.level(y, x);
      const int is = luma.at<std::uint8_t>(y, x);
      if (was - black < kDarkest || was > kBrightest || is > kBrightest) continue;
      const float ratio = static_cast<float>(std::max(is - black, 1)) / static_cast<float>(was - black);
      cells_[static_cast<std::size_t>(y * kRows / luma.rows) * kColumns + x * kColumns / luma.cols].ratios.push_back(ratio);
      all_.push_back(ratio);
    }
  }
}

void LightMeter::assess(Cell& cell, float overall_gain) {
  cell.gain = overall_gain;
  cell.sure = false;
  if (cell.ratios.size() < kMinRatios) return;
  const float gain = geometry::median(cell.ratios);
  const auto agree =
      std::count_if(cell.ratios.begin(), cell.ratios.end(), [&](float ratio) { return std::abs(ratio - gain) < 0.08F * gain; });
  cell.sure = static_cast<std::size_t>(agree) * 10 > cell.ratios.size() * 6;
  if (cell.sure) cell.gain = gain;
}

/// The 3 × 3 median of the cells, spread over the blocks.
cv::Mat LightMeter::smoothed(float overall_gain) const {
  cv::Mat gains(kRows, kColumns, CV_32FC1);
  std::vector<float> round;
  for (int y = 0; y < kRows; ++y) {
    for (int x = 0; x < kColumns; ++x) {
      round.clear();
      for (int v = std::max(0, y - 1); v < std::min(kRows, y + 2); ++v) {
        for (int u = std::max(0, x - 1); u < std::min(kColumns, x + 2); ++u) {
          const Cell& cell = cells_[static_cast<std::size_t>(v) * kColumns + u];
          if (cell.sure) round.push_back(cell.gain);
        }
      }
      gains.at<float>(y, x) = round.size() < 3 ? overall_gain : geometry::median(round);
    }
  }
  return gains;
}

std::optional<LightChange> LightMeter::measure(const cv::Mat& luma, const ScenePlane& scene, int black) {
  sample(luma, scene, black);
  if (all_.size() < kMinRatios) return std::nullopt;
  const float overall_gain = geometry::median(all_);
  for (Cell& cell : cells_) assess(cell, overall_gain);
  const auto sure = std::count_if(cells_.begin(), cells_.end(), [](const Cell& cell) { return cell.sure; });
  if (sure * 2 < kColumns * kRows) return std::nullopt;
  const cv::Mat coarse = smoothed(overall_gain);
  double minimum = 1, greatest = 1;
  cv::minMaxLoc(coarse, &minimum, &greatest);
  if (greatest < 1 + kNoticeable && minimum > 1 - kNoticeable) return std::nullopt;
  LightChange change;
  change.explained = greatest < kMaxMagnitude && minimum > 1 / kMaxMagnitude;
  const cv::Size blocks((luma.cols + ScenePlane::kBlock - 1) / ScenePlane::kBlock,
                        (luma.rows + ScenePlane::kBlock - 1) / ScenePlane::kBlock);
  cv::resize(coarse, change.gains, blocks, 0, 0, cv::INTER_LINEAR);
  return change;
}

double median_difference(const cv::Mat& image, const ScenePlane& scene) {
  std::vector<float> differences;
  const int step = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(image.total()) / kSamples)));
  for (int y = step / 2; y < image.rows; y += step) {
    for (int x = step / 2; x < image.cols; x += step) {
      differences.push_back(static_cast<float>(image.at<std::uint8_t>(y, x)) - static_cast<float>(scene.mean(y)[x]) / 128.0F);
    }
  }
  return differences.empty() ? 0 : geometry::median(differences);
}

}  // namespace marey::detect::background
