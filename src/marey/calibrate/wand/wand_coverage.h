// How much of a waved wand cameras have seen so far, while it is still waved: whether it is enough, and for which not.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "marey/calibrate/wand/wand_marks.h"

namespace marey::calibrate::wand {

class WandCoverage {
 public:
  /// `lenses_known`: whether every camera's lens is given. The others are estimated from the observations, which takes more of
  /// it: with less than half of the image the cameras stood several times as far off as after a minute
  /// (bench/sweep/wand_enough.cpp).
  WandCoverage(MarkerLine wand, std::size_t cameras, bool lenses_known = true)
      : wand_(std::move(wand)), cameras_(cameras), lenses_known_(lenses_known) {}

  /// What a camera gave since the last call, a few seconds of it. Times are by one clock here, as those of live cameras are.
  struct Detected {
    std::span<const BlobFrame> frames;
    std::optional<geometry::Lens> lens;  ///< where it is known
    cv::Size size;                       ///< px; empty if it is not known yet: nothing is counted then
  };
  /// By camera. Two cameras share a view where both saw the wand within `together_s`.
  void add(std::span<const Detected> detected, double together_s);

  /// Share of the camera's image, in 10 × 8 parts, in which the wand was.
  double coverage(std::size_t camera) const;
  /// Those parts, row by row, each a number below `kPartsAcross` × `kPartsDown`.
  const std::set<int>& parts(std::size_t camera) const { return cameras_[camera].parts; }
  /// Views that two cameras share.
  std::int64_t shared(std::size_t a, std::size_t b) const;
  /// Frames of the camera in which the wand was.
  std::int64_t views(std::size_t camera) const { return cameras_[camera].views; }
  /// Whether it was seen in enough of the camera's image; in a volume that is small in it, whether more waving adds nothing.
  bool is_covered(std::size_t camera) const;
  /// Whether every camera is covered, and all are chained by enough views that two of them share.
  bool is_enough() const;

  static constexpr int kPartsAcross = 10, kPartsDown = 8;
  /// Share of a camera's image that is wanted.
  static constexpr double required(bool lenses_known) { return lenses_known ? kWellCovered : kLensCovered; }
  static constexpr double kLensCovered = 0.5;  ///< this much determines its lens too
  static constexpr double kWellCovered = 0.3;  ///< a rig whose least covered camera has this much may be excellent,
  static constexpr double kCovered = 0.2;      ///< and good with this much
  static constexpr std::int64_t kNothingNew = 400, kNothingNewOfLens = 1200, kEnoughShared = 200;  ///< views

 private:
  struct Camera {
    std::set<int> parts;
    std::int64_t views = 0, views_at_growth = 0;  ///< all; and when it was last seen in a new part
  };

  MarkerLine wand_;
  std::vector<Camera> cameras_;
  bool lenses_known_;
  std::map<std::pair<std::size_t, std::size_t>, std::int64_t> shared_;
};

}  // namespace marey::calibrate::wand
