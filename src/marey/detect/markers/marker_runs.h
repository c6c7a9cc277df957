#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/detect/markers/marker_kernel.h"

namespace marey::detect::markers {

/// Neighbouring pixels of one row that pass the threshold.
struct MarkerRun {
  std::int32_t row = 0;
  std::int32_t begin = 0;   ///< first column
  std::int32_t end = 0;     ///< one past the last
  std::int32_t parent = 0;  ///< a run of the same component that comes no later; once searched: the component's number
};

/// Pixels that pass the threshold and touch, by side or corner, with their sums.
struct MarkerBlob {
  cv::Rect box;  ///< px
  std::int64_t area = 0;
  double mean_x = 0, mean_y = 0;            ///< of the pixels' centres
  double var_x = 0, var_y = 0, cov_xy = 0;  ///< of the pixels' whole squares: a lone pixel has 1/12
};

/// What a pixel must pass: one threshold for each tile of 64 × 64 pixels, row of tiles by row of tiles.
struct MarkerThresholds {
  static constexpr int kTile = 64;
  std::vector<std::uint16_t> of_tile;
  bool dark = false;  ///< a pixel passes below its threshold, not above it
};

/// Pixels omitted of every search: one bit each, rows of whole 64-bit words.
class MarkerMask {
 public:
  MarkerMask() = default;
  /// `excluded`: CV_8UC1, any value but 0 leaves the pixel out.
  explicit MarkerMask(const cv::Mat& excluded);

  bool empty() const { return bits_.empty(); }
  cv::Size size() const { return size_; }
  std::uint64_t word(int row, int word) const { return bits_[static_cast<std::size_t>(row) * words_ + word]; }
  bool at(int x, int y) const { return (word(y, x / 64) >> (x % 64) & 1) != 0; }
  /// Omits what `other`, of the same size, omits as well.
  void add(const MarkerMask& other);

 private:
  cv::Size size_;
  int words_ = 0;
  std::vector<std::uint64_t> bits_;
};

/// Connected components (8 neighbours) of the pixels that pass a threshold, in one pass over the image. Buffers are kept from frame
/// to frame.
class MarkerRunFinder {
 public:
  /// At most `most_runs` runs are kept: what lies below is not searched, and `cut_at` says from which row on.
  explicit MarkerRunFinder(std::size_t most_runs, const MarkerKernels& kernels = marker_kernels());

  /// `image`: CV_8UC1 or CV_16UC1. Blobs in the order of their first pixel, top to bottom, left to right.
  std::span<const MarkerBlob> find(const cv::Mat& image, const MarkerThresholds& thresholds, const MarkerMask& mask);

  std::span<const MarkerRun> runs() const { return runs_; }
  std::optional<int> cut_at() const { return cut_at_; }

 private:
  void scan(const cv::Mat& image, const MarkerThresholds& thresholds, const MarkerMask& mask);
  void add_word(int row, int word, std::uint64_t bits);
  void join_rows(std::size_t above, std::size_t here);
  std::int32_t root(std::int32_t run);
  void sum_up();

  std::size_t max_runs_;
  const MarkerKernels& kernels_;
  std::vector<MarkerHit> hits_;
  std::vector<MarkerRun> runs_;
  std::vector<MarkerBlob> blobs_;
  std::optional<int> cut_at_;
};

}  // namespace marey::detect::markers
