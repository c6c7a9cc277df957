#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/detect/markers/marker_runs.h"

namespace marey::detect::markers {

/// The brightness of the empty scene, tile by tile, its noise, and the threshold that follows from them. Learned from the whole
/// first frame, then from a share of the tiles every frame: it follows slow changes of the light.
///
/// All "heights" are counted in the direction in which markers stand out: upwards, or downwards where `dark`.
class MarkerLevels {
 public:
  MarkerLevels(bool dark, std::optional<double> fixed_threshold) : dark_(dark), fixed_(fixed_threshold) {}

  /// Looks at a share of the tiles; at all of them the first time, after the image's size or depth changed, or where `afresh`.
  void learn(const cv::Mat& image, bool afresh = false);

  /// How far markers stand out from their background, from the blobs of a frame; nothing where there were none.
  void learn_contrast(std::optional<double> contrast);

  const MarkerThresholds& thresholds() const { return thresholds_; }
  /// Standard deviation of the pixels' noise, grey levels; rounding included.
  double noise() const { return noise_; }
  /// Background at a pixel, grey levels.
  double background(int x, int y) const;
  /// The contrast that a pixel must have to pass, grey levels.
  double least_contrast(int x, int y) const;
  /// The middle of least_contrast over all tiles; 0 before the first frame.
  double typical_least_contrast() const;
  /// White: 255, or for 16 bits one below the smallest power of two that no pixel of the first frame reached.
  double white() const { return white_; }

 private:
  struct Tile {
    std::uint16_t median = 0;
    float spread = 0;  ///< standard deviation of the background, from its side away from the markers
  };

  void begin(const cv::Mat& image);
  void sample(const cv::Mat& image, int tile);
  void set_threshold(int tile);
  double smooth_median(int tile) const;
  void learn_noise();
  double needed(int tile) const;

  bool dark_;
  std::optional<double> fixed_;
  cv::Size size_;
  std::optional<int> depth_;  // OpenCV's, of the last image
  cv::Size tiles_;
  double white_ = 255;
  double noise_ = 1;
  double contrast_ = 0;
  int next_ = 0;
  std::vector<Tile> raw_;
  std::vector<double> level_;           ///< smoothed medians
  std::vector<std::uint32_t> changes_;  ///< histogram of differences between pixels, for the noise
  MarkerThresholds thresholds_;
};

}  // namespace marey::detect::markers
