// Over the cells of a grid the gain that best maps the scene to the frame is found by least squares from 8 × 8 pixels each. A cell
// shows something only where it has texture, and the frame shows that texture: then it is the scene, however lit. Cells that
// cannot decide (smooth ones, those that people cover) go by their neighbours that can. A person who happens to look like the scene
// covers a few cells; a cloud's shadow or a lamp's cone covers many, or grows out of where it was. Cost: 192 pixels read in each of
// some 300 cells.
#include "marey/detect/background/background_patches.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace marey::detect::background {
namespace {

constexpr int kCellsAcross = 20;
constexpr int kMinCellCount = 12;         // px
constexpr int kSamplesAcross = 8;         // of a cell
constexpr double kMinTexture = 20;        // squared levels: the variance of the scene's part in a cell that decides
constexpr double kObservedThrough = 0.6;  // squared correlation
constexpr double kUnevenLight = 0.1;      // of the level: how far a cell's pixels may lie off their common gain
constexpr double kPatchNoise = 12;        // squared levels
constexpr float kOtherLight = 0.04F;
constexpr float kMaxLight = 2.0F;
constexpr double kMinSteps = 10;     // squared levels: of the scene's steps between neighbours in a cell that decides
constexpr double kSameSteps = 0.4;   // squared correlation of the steps
constexpr double kStepsGain = 0.3;   // how far the steps' gain may be from the levels'
constexpr double kManyCells = 0.04;  // of the grid: as many in another light are not people
constexpr int kMinPart = 4;          // cells side by side
constexpr int kLately = 30;          // inspections
constexpr int kAgreeing = 2;         // min. neighbours that a cell which cannot decide goes by

}  // namespace

void LightPatches::sample(const cv::Mat& luma, const ScenePlane& scene, int black) {
  const int cell = std::max(kMinCellCount, luma.cols / kCellsAcross);
  grid_ = {std::max(1, luma.cols / cell), std::max(1, luma.rows / cell)};
  cells_.assign(static_cast<std::size_t>(grid_.area()), {});
  const int step = std::max(1, cell / kSamplesAcross);
  columns_.clear();
  for (int x = step / 2; x < luma.cols; x += step) columns_.push_back(x * grid_.width / luma.cols);
  for (int y = step / 2; y < luma.rows; y += step) {
    const auto* pixels = luma.ptr<std::uint8_t>(y);
    const std::int16_t* means = scene.mean(y);
    const int under = y + step < luma.rows ? y + step : y;
    const auto* pixels_under = luma.ptr<std::uint8_t>(under);
    const std::int16_t* means_under = scene.mean(under);
    Cell* row = &cells_[static_cast<std::size_t>(y) * grid_.height / luma.rows * grid_.width];
    int x = step / 2;
    for (const int column : columns_) {
      Cell& one = row[column];
      const int is = pixels[x] - black, was = ((means[x] + 64) >> 7) - black;
      const int right = std::min(x + step, luma.cols - 1);
      one.add_step(pixels[right] - pixels[x], (means[right] - means[x]) / 128);
      one.add_step(pixels_under[x] - pixels[x], (means_under[x] - means[x]) / 128);
      x += step;
      ++one.count;
      one.frame += is, one.scene += was;
      one.frame2 += is * is, one.scene2 += was * was, one.both += is * was;
    }
  }
}

/// Light multiplies the steps between neighbours as it does the levels; a smooth wall and a coat share a slope by chance, but
/// barely the small steps on it.
bool LightPatches::has_same_steps(const Cell& cell, double gain) {
  const double frame = cell.step_frame2, scene = cell.step_scene2, both = cell.step_both;
  if (scene < kMinSteps * cell.steps || both <= 0 || both * both < kSameSteps * scene * frame) return false;
  return std::abs(std::sqrt(frame / scene) / gain - 1) < kStepsGain;
}

LightPatches::Answer LightPatches::assess(const Cell& cell, float& gain) {
  gain = 1;
  if (cell.count < kSamplesAcross * kSamplesAcross / 2 || cell.scene2 <= 0) return Answer::unknown;
  const double n = cell.count, frame = cell.frame, scene = cell.scene;
  const double ratio = static_cast<double>(cell.both) / cell.scene2;
  const double texture = (cell.scene2 - scene * scene / n) / n;
  const double detected = (cell.frame2 - frame * frame / n) / n;
  const double shared = (cell.both - frame * scene / n) / n;
  const double left_over = (cell.frame2 - ratio * cell.both) / n;
  const double uneven = kUnevenLight * frame / n;
  if (texture < kMinTexture || shared <= 0 || shared * shared < kObservedThrough * texture * detected) return Answer::unknown;
  if (left_over > kPatchNoise + uneven * uneven || ratio > kMaxLight || ratio < 1 / kMaxLight) return Answer::unknown;
  if (!has_same_steps(cell, ratio)) return Answer::unknown;
  if (std::abs(ratio - 1) < kOtherLight) return Answer::as_before;
  gain = static_cast<float>(ratio);
  return Answer::other;
}

/// Of the cells in another light leaves those that are many: in the image, side by side, or beside such that were there lately.
/// False where none are left.
bool LightPatches::drop_few() {
  cv::Mat other(grid_, CV_8UC1), parts, sizes, centres, near;
  for (std::size_t i = 0; i < cells_.size(); ++i) other.data[i] = answers_[i] == Answer::other ? 255 : 0;
  if (lately_.size() != grid_) lately_ = cv::Mat::zeros(grid_, CV_8UC1);
  if (cv::countNonZero(other) < kManyCells * static_cast<double>(cells_.size())) {
    const int count = cv::connectedComponentsWithStats(other, parts, sizes, centres, 4);
    cv::dilate(lately_, near, {});
    std::vector<bool> trusted(static_cast<std::size_t>(count), false);
    for (int i = 1; i < count; ++i) trusted[static_cast<std::size_t>(i)] = sizes.at<int>(i, cv::CC_STAT_AREA) >= kMinPart;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (near.data[i] > 0) trusted[static_cast<std::size_t>(parts.ptr<int>()[i])] = true;
    }
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (answers_[i] != Answer::other || trusted[static_cast<std::size_t>(parts.ptr<int>()[i])]) continue;
      answers_[i] = Answer::unknown;
      gains_[i] = 1;
      other.data[i] = 0;
    }
  }
  cv::subtract(lately_, 1, lately_);
  lately_.setTo(kLately, other);
  return cv::countNonZero(other) > 0;
}

std::optional<cv::Mat> LightPatches::measure(const cv::Mat& luma, const ScenePlane& scene, int black) {
  sample(luma, scene, black);
  answers_.assign(cells_.size(), Answer::unknown);
  gains_.assign(cells_.size(), 1);
  for (std::size_t i = 0; i < cells_.size(); ++i) answers_[i] = assess(cells_[i], gains_[i]);
  if (!drop_few()) return std::nullopt;
  cv::Mat gains(grid_, CV_32FC1, cv::Scalar(1));
  for (int y = 0; y < grid_.height; ++y) {
    for (int x = 0; x < grid_.width; ++x) {
      const std::size_t own = static_cast<std::size_t>(y) * grid_.width + x;
      float sum = 0;
      int count = 0;
      for (int v = std::max(0, y - 1); v < std::min(grid_.height, y + 2); ++v) {
        for (int u = std::max(0, x - 1); u < std::min(grid_.width, x + 2); ++u) {
          const std::size_t at = static_cast<std::size_t>(v) * grid_.width + u;
          if (answers_[at] == Answer::unknown) continue;
          sum += gains_[at];
          ++count;
        }
      }
      float& gain = gains.at<float>(y, x);
      if (answers_[own] != Answer::unknown)
        gain = gains_[own];
      else if (count >= kAgreeing)
        gain = sum / static_cast<float>(count);
    }
  }
  return gains;
}

}  // namespace marey::detect::background
