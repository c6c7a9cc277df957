#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "marey/core/observation.h"
#include "marey/reconstruct/sight_line.h"

namespace marey::reconstruct {

/// Everything that the cameras of a rig saw at one instant, as sight lines: those of one camera side by side, and within a camera
/// those of one cell of a grid over its image, so that the blobs near a pixel are found in a few cells.
/// Steady state allocates nothing. Cost: one lens inversion a blob, and a counting sort.
class FrameRays {
 public:
  /// `ids[i]` is what observations call cameras[i].
  FrameRays(std::vector<Camera> cameras, std::span<const CameraId> ids);

  /// Takes in the observations. Blobs that no direction leads to, and those of cameras that the rig does not have, are omitted.
  /// `noise_px` is the standard deviation, along each axis, of what an observation's own covariance does not cover.
  void build(std::span<const Observation<2>> detected, double noise_px);

  std::span<const Camera> all_cameras() const { return cameras_; }
  int cameras() const { return static_cast<int>(cameras_.size()); }
  const Camera& camera(int number) const { return cameras_[number]; }
  int size() const { return static_cast<int>(lines_.size()); }

  const SightLine& line(int ray) const { return lines_[ray]; }
  std::span<const SightLine> lines() const { return lines_; }
  const Vector<2>& pixel(int ray) const { return pixels_[ray]; }
  int observation(int ray) const { return observations_[ray]; }  ///< index in the observations
  int first(int camera) const { return grids_[camera].begin; }   ///< rays first(c) … last(c) − 1 are camera c's
  int last(int camera) const { return grids_[camera].end; }
  double largest_sigma(int camera) const { return grids_[camera].largest_sigma; }

  /// Calls `visit(ray)` for every ray of the camera whose pixel may lie within `radius` px of `pixel`: all that do, and others
  /// near them, in an order that depends on the rays alone.
  template <typename Visit>
  void for_each_near(int camera, const Vector<2>& pixel, double radius, Visit&& visit) const {
    const Grid& grid = grids_[camera];
    if (grid.begin == grid.end) return;
    const int left = grid.column(pixel.x() - radius), right = grid.column(pixel.x() + radius);
    const int top = grid.row(pixel.y() - radius), bottom = grid.row(pixel.y() + radius);
    for (int row = top; row <= bottom; ++row) {
      const int* starts = grid.starts.data() + static_cast<std::ptrdiff_t>(row) * grid.columns;
      for (int ray = starts[left]; ray < starts[right + 1]; ++ray) visit(ray);
    }
  }

 private:
  struct Grid {
    int begin = 0, end = 0;
    int columns = 1, rows = 1;
    double cell = 1;  // px
    double largest_sigma = 0;
    std::vector<int> starts;  // of each cell, row by row, and the end

    /// What lies outside the image belongs to a border cell.
    int column(double x) const { return clamped(x / cell, columns); }
    int row(double y) const { return clamped(y / cell, rows); }
    static int clamped(double cell, int count) { return cell > 0 ? cell < count ? static_cast<int>(cell) : count - 1 : 0; }
    int cell_of(const Vector<2>& pixel) const { return row(pixel.y()) * columns + column(pixel.x()); }
  };

  void lay_grid(int camera, std::span<const Observation<2>> detected);

  std::vector<Camera> cameras_;
  std::vector<std::optional<int>> number_of_;  // by CameraId, the camera's place in `cameras_`
  std::vector<Grid> grids_;
  std::vector<std::optional<SightLine>> found_;  // by observation
  std::vector<SightLine> lines_;
  std::vector<Vector<2>> pixels_;
  std::vector<int> observations_;
  std::vector<int> by_camera_, order_, sorted_, starts_, starts_of_cells_;
};

}  // namespace marey::reconstruct
