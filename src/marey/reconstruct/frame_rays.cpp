#include "marey/reconstruct/frame_rays.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

namespace marey::reconstruct {
namespace {

constexpr double kMinCell = 8;       // px
constexpr int kMaxCells = 4096;      // a camera; numerical: time of the search alone
constexpr std::size_t kGrain = 512;  // blobs: lens inversions that are worth a task (numerical: time alone)

double sigma_of(const Observation<2>& one, double noise_px) {
  return std::max(std::sqrt((one.covariance ? std::max(0.0, one.covariance->trace() / 2) : 0) + noise_px * noise_px), 1e-6);
}

}  // namespace

FrameRays::FrameRays(std::vector<Camera> cameras, std::span<const CameraId> ids)
    : cameras_(std::move(cameras)), grids_(cameras_.size()) {
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const auto id = static_cast<std::size_t>(number(ids[i]));
    if (number_of_.size() <= id) number_of_.resize(id + 1);
    number_of_[id] = static_cast<int>(i);
  }
}

void FrameRays::build(std::span<const Observation<2>> detected, double noise_px) {
  lines_.clear();
  pixels_.clear();
  observations_.clear();
  starts_.assign(cameras_.size() + 1, 0);
  const auto camera_of = [&](const Observation<2>& one) -> std::optional<int> {
    const auto id = static_cast<std::size_t>(number(one.camera));
    return id < number_of_.size() && one.value.allFinite() ? number_of_[id] : std::nullopt;
  };
  for (const Observation<2>& one : detected) {
    if (const auto camera = camera_of(one)) ++starts_[*camera + 1];
  }
  for (std::size_t c = 0; c < cameras_.size(); ++c) starts_[c + 1] += starts_[c];
  by_camera_.resize(static_cast<std::size_t>(starts_.back()));
  for (int i = 0; i < std::ssize(detected); ++i) {
    if (const auto camera = camera_of(detected[i])) by_camera_[starts_[*camera]++] = i;
  }
  found_.assign(detected.size(), std::nullopt);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, detected.size(), kGrain), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      if (const auto camera = camera_of(detected[i]))
        found_[i] = sight_line(cameras_[*camera], *camera, detected[i].value, sigma_of(detected[i], noise_px));
    }
  });
  // Each start has moved to the next one's.
  for (int c = 0, begin = 0; c < cameras(); begin = starts_[c++]) {
    order_.assign(by_camera_.begin() + begin, by_camera_.begin() + starts_[c]);
    lay_grid(c, detected);
    Grid& grid = grids_[c];
    grid.begin = size();
    grid.largest_sigma = 0;
    int excluded = 0;
    std::size_t cell = 0;
    for (int k = 0; k < std::ssize(order_); ++k) {
      while (cell < grid.starts.size() && grid.starts[cell] <= k) grid.starts[cell++] += grid.begin - excluded;
      const Observation<2>& one = detected[order_[k]];
      const auto& line = found_[static_cast<std::size_t>(order_[k])];
      if (!line) {
        ++excluded;
        continue;
      }
      lines_.push_back(*line);
      pixels_.push_back(one.value);
      observations_.push_back(order_[k]);
      grid.largest_sigma = std::max(grid.largest_sigma, line->sigma);
    }
    while (cell < grid.starts.size()) grid.starts[cell++] += grid.begin - excluded;
    grid.end = size();
  }
}

/// Sorts `order_` by cells; `starts` then counts from the camera's first blob.
void FrameRays::lay_grid(int camera, std::span<const Observation<2>> detected) {
  Grid& grid = grids_[camera];
  const cv::Size size = cameras_[camera].size();
  const double area = std::max(1.0, static_cast<double>(size.width) * size.height);
  const double cells = std::clamp<double>(static_cast<double>(order_.size()), 1, kMaxCells);
  grid.cell = std::max(kMinCell, std::sqrt(area / cells));
  grid.columns = static_cast<int>(size.width / grid.cell) + 1;
  grid.rows = static_cast<int>(size.height / grid.cell) + 1;
  grid.starts.assign(static_cast<std::size_t>(grid.columns) * grid.rows + 1, 0);
  for (const int i : order_) ++grid.starts[grid.cell_of(detected[i].value) + 1];
  for (std::size_t i = 1; i < grid.starts.size(); ++i) grid.starts[i] += grid.starts[i - 1];
  starts_of_cells_.assign(grid.starts.begin(), grid.starts.end());
  sorted_.resize(order_.size());
  for (const int i : order_) sorted_[starts_of_cells_[grid.cell_of(detected[i].value)]++] = i;
  order_.swap(sorted_);
}

}  // namespace marey::reconstruct
