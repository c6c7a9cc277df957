#pragma once

#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/detect/background/background_shadow.h"

namespace marey::detect::background {

/// Images of a scene that was not learned ahead, evenly over the time since its model began: sixteen at most. Each time there are
/// this many, every second one goes, and the next come half as often; after six times that is about a minute.
class SceneSamples {
 public:
  void begin();

  /// Keeps this frame's planes where it is time. True if they show more than before: of the first ones four and eight do, then
  /// all sixteen. `thin` follows.
  bool keep(const FramePlanes& planes, double age_s);
  /// Where the samples are full, leaves every second one out; after the last time, all.
  void thin();

  /// Of images in another light nothing is left: those that come are as often.
  void forget();

  std::span<const cv::Mat> luma() const { return luma_; }
  std::span<const cv::Mat> cb() const { return cb_; }
  std::span<const cv::Mat> cr() const { return cr_; }

 private:
  static constexpr std::size_t kMaxCount = 16;  // numerical: more only cost memory
  static constexpr int kTimes = 6;
  static constexpr double kFirstInterval_s = 0.1;

  std::vector<cv::Mat> luma_, cb_, cr_;
  double interval_s_ = kFirstInterval_s, next_s_ = 0;
  int thinned_ = kTimes;  ///< nothing is kept until `begin`
};

}  // namespace marey::detect::background
