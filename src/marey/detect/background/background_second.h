#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/detect/background/background_plane.h"
#include "marey/detect/background/background_regions.h"

namespace marey::detect::background {

/// Observations in front of the scene that stay: each pixel's second mean, and for how long it was seen. What has stayed for long
/// enough becomes the scene, and what was the scene is remembered in its place. Counts in ticks, a 200th of the time after which
/// what stands still is absorbed.
class SecondScene {
 public:
  explicit SecondScene(double absorb_after_s);

  /// `learned_ahead`: the scene was learned from images beforehand; else each pixel's is only as sure as it has been seen since.
  void begin(cv::Size size, bool learned_ahead);

  /// Whole ticks between two ages of the model, s.
  int ticks_between(double earlier_s, double later_s) const;

  /// Whether a pixel of this level was seen there for this long before that it is not news.
  bool knows(int row, int column, std::uint8_t level) const;

  /// Where a row shows the scene, the foreground seen before it fades, and is noted (in the level's last bit) to be away.
  void forget(int row, int ticks, const ForegroundRegions& regions);

  /// Counts, for the foreground pixels of a row of a model of this age, how long they have been the same; those that `held` marks
  /// are left alone, but for ghosts. `taken` gets the columns where the frame has become scene, whose means the caller then
  /// changes.
  void count(int row, const std::uint8_t* pixels, const std::uint8_t* held, const ForegroundRegions& regions, int ticks,
             double age_s, ScenePlane& scene, std::vector<int>& taken);

 private:
  int ticks_to_stay(double age_s, int seen_as_scene) const;

  double tick_s_;
  bool learned_ahead_ = false;
  cv::Mat level_;     ///< CV_8UC1: the level seen at a pixel while it was foreground, or scene before
  cv::Mat detected_;  ///< CV_8UC1: for how long, in ticks
  cv::Mat scene_;     ///< CV_8UC1: for how long the scene was seen, in ticks; empty if it was learned ahead
};

}  // namespace marey::detect::background
