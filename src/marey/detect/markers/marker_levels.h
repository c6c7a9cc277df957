#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/detect/markers/marker_runs.h"

namespace marey::detect::markers {

/// What the markers of an image are like, grey levels.
struct TypicalMarker {
  double contrast = 0;  ///< over what is around them
  double top = 0;       ///< their own level; of dark ones, counted down from white
};

/// The brightness of the empty scene, tile by tile, its noise, and the threshold that follows from them. Learned from the whole
/// first frame, then from a share of the tiles every frame: it follows slow changes of the light.
///
/// All "heights" are counted in the direction in which markers stand out: upwards, or downwards where `dark`.
class MarkerLevels {
 public:
  /// `smoothed`: a tile's ground is the middle of those around; else its own.
  MarkerLevels(bool dark, std::optional<double> fixed_threshold, bool smoothed = true)
      : dark_(dark), fixed_(fixed_threshold), smoothed_(smoothed) {}

  /// Inspects a share of the tiles; all of them the first time, after the image's size or depth changed, or where `afresh`.
  void learn(const cv::Mat& image, bool afresh = false);

  /// What markers of a frame are like; nothing if there were none.
  void learn_contrast(const std::optional<TypicalMarker>& typical);
  /// The same at once, for all tiles.
  void set_contrast(const TypicalMarker& typical);
  /// The estimate of their contrast, grey levels; 0 where nothing is.
  double contrast() const { return typical_.contrast; }
  /// How far a marker stands out from a ground of this grey level, at least: a share of what others do, but no more than would make
  /// it as bright as a faint one of them.
  double demand(double ground) const;
  /// What stands out by less in that tile (row of tiles by row of tiles) may be noise.
  double noise_demand(int tile) const;
  /// The middle of a tile's ground and the brighter of the levels that meet in it, grey levels.
  double level(int tile) const { return level_[static_cast<std::size_t>(tile)]; }
  double brighter_level(int tile) const;

  const MarkerThresholds& thresholds() const { return thresholds_; }
  /// Standard deviation of the pixels' noise, grey levels; rounding included.
  double noise() const { return noise_; }
  /// Background at a pixel, grey levels.
  double background(int x, int y) const;
  /// The contrast that a pixel must have to pass, grey levels.
  double min_contrast(int x, int y) const;
  /// The middle of min_contrast over all tiles; 0 before the first frame.
  double typical_min_contrast() const;
  /// Whether grounds of several levels meet in a tile (row of tiles by row of tiles), or it is another than those around, so that a
  /// threshold for all of it loses markers on the darker one.
  bool is_uneven(int tile) const;
  int tile_count() const { return tiles_.area(); }
  /// White: 255, or for 16 bits one below the smallest power of two that no pixel of the first frame reached.
  double white() const { return white_; }

 private:
  struct Tile {
    std::uint16_t median = 0;
    std::uint16_t high = 0;  ///< the level that a seventh of the samples lie above
    float step = 0;          ///< between the levels that meet in the tile: within which seven tenths of its samples lie
    float spread = 0;        ///< standard deviation of the background, from its side away from the markers
  };

  void begin(const cv::Mat& image);
  double minimum() const;
  void sample(const cv::Mat& image, int tile);
  void set_threshold(int tile);
  double smooth_median(int tile) const;
  void learn_noise();
  double needed(int tile) const;

  bool dark_;
  std::optional<double> fixed_;
  bool smoothed_;
  cv::Size size_;
  std::optional<int> depth_;  // OpenCV's, of the last image
  cv::Size tiles_;
  double white_ = 255;
  double noise_ = 1;
  TypicalMarker typical_;
  int next_ = 0;
  std::vector<Tile> raw_;
  std::vector<double> level_;           ///< smoothed medians
  std::vector<std::uint32_t> changes_;  ///< histogram of differences between pixels, for the noise
  MarkerThresholds thresholds_;
};

}  // namespace marey::detect::markers
