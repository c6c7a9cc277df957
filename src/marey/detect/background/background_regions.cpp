#include "marey/detect/background/background_regions.h"

#include <cstdlib>

namespace marey::detect::background {
namespace {

constexpr int kStrongPixels = 4;  // that make a region count
constexpr int kMinPixels = 10;    // of a region
constexpr int kSlender = 100;     // px: a smaller region must be solid somewhere; a drop of rain is not

}  // namespace

void ForegroundRegions::choose(const MarkedRuns& marked, int rows) {
  const std::size_t count = marked.runs.size();
  sets_.reset(count);
  join_neighbours(marked.runs, 1, sets_);
  areas_.assign(count, 0);
  strongs_.assign(count, 0);
  solids_.assign(count, 0);
  for (std::size_t i = 0; i < count; ++i) {
    const int root = sets_.find(static_cast<int>(i));
    areas_[root] += marked.runs[i].end - marked.runs[i].begin;
    strongs_[root] += marked.strong[i];
    solids_[root] += marked.solid[i];
  }
  runs_.clear();
  region_.clear();
  borders_.clear();
  numbers_.assign(count, -1);
  for (std::size_t i = 0; i < count; ++i) {
    const int root = sets_.find(static_cast<int>(i));
    if (areas_[root] < kMinPixels || strongs_[root] < kStrongPixels) continue;
    if (areas_[root] < kSlender && solids_[root] == 0) continue;
    if (numbers_[root] < 0) {
      numbers_[root] = static_cast<int>(borders_.size());
      borders_.push_back({});
    }
    runs_.push_back(marked.runs[i]);
    region_.push_back(numbers_[root]);
  }
  row_begin_.assign(static_cast<std::size_t>(rows) + 1, 0);
  for (const PixelRun& run : runs_) ++row_begin_[run.row + 1];
  for (int y = 0; y < rows; ++y) row_begin_[y + 1] += row_begin_[y];
}

void ForegroundRegions::compare_borders(const cv::Mat& luma, const ScenePlane& scene) {
  constexpr int kAcross = 3;
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    const PixelRun& run = runs_[i];
    if (run.end - run.begin < 2 * kAcross) continue;
    const auto* pixels = luma.ptr<std::uint8_t>(run.row);
    const std::int16_t* means = scene.mean(run.row);
    Border& ghost = borders_[region_[i]];
    const auto add = [&](int inside, int outside) {
      if (outside < 0 || outside >= luma.cols) return;
      ghost.frame += std::abs(pixels[inside] - pixels[outside]);
      ghost.scene += std::abs(means[inside] - means[outside]) / 128.0;
      ++ghost.count;
    };
    add(run.begin + kAcross - 1, run.begin - kAcross);
    add(run.end - kAcross, run.end - 1 + kAcross);
  }
}

}  // namespace marey::detect::background
