#pragma once

#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/detect/markers/marker_levels.h"
#include "marey/detect/markers/marker_runs.h"

namespace marey::detect::markers {

/// Where an image shows more than a plain ground: tiles of 64 × 64 px in which something wide stands out, or noise on something
/// wide. There the image less what is wider than a marker is searched (Serra 1982: the top-hat), elsewhere the image itself.
class MarkerClutter {
 public:
  explicit MarkerClutter(bool dark) : dark_(dark), heights_levels_(false, std::nullopt, false) {}

  /// Forgets everything, for images of this size. `everywhere`: all tiles are cluttered, and stay so.
  void begin(cv::Size size, bool everywhere);
  bool any() const { return marked_count_ > 0; }
  bool at(int tile) const { return tiles_[static_cast<std::size_t>(tile)] != 0; }
  /// Of a pixel in an image of this size: row of tiles by row of tiles.
  static int tile_of(int x, int y, cv::Size size) {
    constexpr int kTile = MarkerThresholds::kTile;
    return y / kTile * ((size.width + kTile - 1) / kTile) + x / kTile;
  }

  /// Returns whether the tile (row of tiles by row of tiles) was plain before.
  bool mark(int tile);
  /// Marks the tiles that runs of the blobs touch for which `which` is not 0. Returns whether one of them was plain before.
  bool mark(std::span<const MarkerRun> runs, std::span<const char> which);
  /// One of the blobs of noise in a tile, of which `many` mark it. Returns whether it was plain and is not any more.
  bool mark_noise(int tile, int many);
  /// The next image's noise is counted from 0.
  void clear_noise();
  /// What was clutter may have gone: all tiles are plain again, unless they are so everywhere.
  void forget();

  /// What is to be searched in the place of `luma`, with what is wider than `widest` px taken out of the cluttered tiles.
  const cv::Mat& plane(const cv::Mat& luma, double widest);
  /// Its thresholds: those of the image, but for the cluttered tiles.
  const MarkerThresholds& thresholds(const MarkerLevels& image);
  /// Inspects all of the last plane once more: the light has changed.
  void relearn() { heights_levels_.learn(heights_, true); }
  /// Of the plane's heights over what is wide.
  MarkerLevels& levels() { return heights_levels_; }

 private:
  void lift(const cv::Mat& luma, const cv::Rect& area, const cv::Mat& shape);

  bool dark_;
  bool everywhere_ = false;
  int columns_ = 0;
  int marked_count_ = 0;
  std::vector<char> tiles_;
  std::vector<int> noise_;  // blobs of it in each tile
  MarkerLevels heights_levels_;
  bool fresh_ = false;  // a tile was marked since the last plane was made
  cv::Mat heights_, lifted_, plane_;
  MarkerThresholds thresholds_;
};

}  // namespace marey::detect::markers
