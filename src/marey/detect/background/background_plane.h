#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/detect/background/background_kernels.h"

namespace marey::detect::background {

/// What one plane of the empty scene looks like: for each pixel a mean, the spread of its noise, and the band of levels that
/// belong to the scene. All planes are of one size; images are CV_8UC1.
class ScenePlane {
 public:
  /// A level belongs to the scene within `floor` levels of the mean, or within `gate` / 16 spreads where the noise is stronger.
  ScenePlane(int floor, int gate) : floor_(floor), gate_(gate) {}

  /// Begins with one image taken for the scene.
  void begin(const cv::Mat& image);

  /// Begins with what the samples have in common: at each pixel the middle of the shortest interval that holds half of them.
  void begin(std::span<const cv::Mat> samples);

  /// Corrects what was begun with too little by what samples since then have in common, at pixels that `fixed` (CV_8UC1, of this
  /// plane's size) does not mark: no pixel's noise is taken for less than among the samples, and where at least twice as many of
  /// them agree with one another as with the scene, they are the scene. `doubted` (likewise) marks where that may be.
  void correct(std::span<const cv::Mat> samples, const cv::Mat& fixed, const cv::Mat& flagged);

  /// Takes levels and spreads (1/8 levels), both CV_8UC1 of this plane's size, for the scene's where `where` is not 0.
  void replace(const cv::Mat& levels, const cv::Mat& spreads, const cv::Mat& where);

  /// Learns rows [first, last) of `image` at the rate 2^-shift; `frozen(row)` gives the row's pixels to leave alone.
  template <typename Frozen>
  void learn(const cv::Mat& image, int first, int last, int shift, Frozen&& frozen) {
    for (int row = first; row < last; ++row) {
      kernels_.learn(image.ptr<std::uint8_t>(row), frozen(row), image.cols, shift, mean_.ptr<std::int16_t>(row),
                     spread_.ptr<std::uint8_t>(row));
    }
    renew_bands(first, last);
  }

  /// Takes one pixel's level for the scene's. Its band is renewed when its row is learned.
  void trust(int row, int column, std::uint8_t level) {
    mean_.at<std::int16_t>(row, column) = static_cast<std::int16_t>(level << 7);
  }

  /// Raises the spread of a pixel's noise, by 1/8 levels.
  void widen(int row, int column, int eighths) {
    auto& spread = spread_.at<std::uint8_t>(row, column);
    spread = static_cast<std::uint8_t>(std::min(255, spread + eighths));
  }

  /// Multiplies every mean's distance from `origin` by a gain: `gains` (CV_32F) has one for each block of kBlock × kBlock pixels.
  void scale(const cv::Mat& gains, int origin);
  /// The same with the gains of a grid's cells, which cover the plane evenly, mixed between their centres.
  void relight(const cv::Mat& gains, int origin);
  /// Adds to every mean.
  void shift(double levels);

  /// The mean's level.
  std::uint8_t level(int row, int column) const {
    return static_cast<std::uint8_t>((mean_.at<std::int16_t>(row, column) + 64) >> 7);
  }
  /// The means' levels, CV_8UC1.
  cv::Mat image() const { return image({{}, mean_.size()}); }
  /// The same within `part`.
  cv::Mat image(const cv::Rect& part) const;
  const std::int16_t* mean(int row) const { return mean_.ptr<std::int16_t>(row); }
  const std::uint8_t* low(int row) const { return low_.ptr<std::uint8_t>(row); }
  const std::uint8_t* high(int row) const { return high_.ptr<std::uint8_t>(row); }
  cv::Size size() const { return mean_.size(); }

  static constexpr int kBlock = 32;

 private:
  void make_room(cv::Size size);
  template <typename Row>
  void summarise(std::span<const cv::Mat> samples, Row&& row) const;
  void renew_bands(int first, int last);

  int floor_, gate_;
  cv::Mat mean_;        ///< CV_16SC1, 1/128 level
  cv::Mat spread_;      ///< CV_8UC1, 1/8 level: what a quarter of the noise exceeds
  cv::Mat low_, high_;  ///< CV_8UC1: the band
  const BackgroundKernels& kernels_ = background_kernels();
};

}  // namespace marey::detect::background
