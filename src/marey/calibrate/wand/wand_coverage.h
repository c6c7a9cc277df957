// How much of a waved wand cameras have seen so far, while it is still waved: whether it is enough, and for which not.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "marey/calibrate/image_coverage.h"
#include "marey/calibrate/wand/wand_marks.h"

namespace marey::calibrate::wand {

class WandCoverage {
 public:
  /// `lenses_known`: whether every camera's lens is given. The others are estimated from the observations, which takes more of
  /// it: with less than half of the image the cameras stood several times as far off as after a minute
  /// (bench/sweep/wand_enough.cpp).
  WandCoverage(MarkerLine wand, std::size_t cameras, bool lenses_known = true)
      : wand_(std::move(wand)), images_(cameras, criteria(lenses_known)) {}

  /// What a camera gave since the last call, a few seconds of it. Times are by one clock here, as those of live cameras are.
  struct Detected {
    std::span<const BlobFrame> frames;
    std::optional<geometry::Lens> lens;  ///< where it is known
    cv::Size size;                       ///< px; empty if it is not known yet: nothing is counted then
  };
  /// By camera. Two cameras share a view where both saw the wand within `together_s`.
  void add(std::span<const Detected> detected, double together_s);

  const ImageCoverage& images() const { return images_; }

  static constexpr ImageCoverage::Criteria criteria(bool lenses_known) {
    return {lenses_known ? kWellCovered : kLensCovered, kCovered, lenses_known ? kNothingNew : kNothingNewOfLens, kEnoughShared};
  }
  static constexpr double kLensCovered = 0.5;  ///< of a camera's image: this much determines its lens too
  static constexpr double kWellCovered = 0.3;  ///< a rig whose least covered camera has this much may be excellent,
  static constexpr double kCovered = 0.2;      ///< and good with this much
  static constexpr std::int64_t kNothingNew = 400, kNothingNewOfLens = 1200, kEnoughShared = 200;  ///< views

 private:
  MarkerLine wand_;
  ImageCoverage images_;
};

}  // namespace marey::calibrate::wand
