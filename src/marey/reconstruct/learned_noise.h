#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "marey/geometry/median.h"
#include "marey/reconstruct/correspond.h"

namespace marey::reconstruct {

/// How far blobs lie from where their markers should be seen: the detector's noise and the calibration's together, px along each
/// axis. Learned from how well rays of points meet that have many of them: it begins wide and follows slowly, so that a wide net is
/// cast first and ghosts find no company later.
class LearnedNoise {
 public:
  /// A noise that is given stays as it is.
  explicit LearnedNoise(std::optional<double> given) : px_(given.value_or(kFirst)), given_(given.has_value()) {}

  double px() const { return px_; }

  /// Takes in an instant's points; whether the noise has changed by what matters.
  bool learn(const Correspondences& found) {
    if (given_) return false;
    ratios_.clear();
    for (const Located& located : found.points) {
      if (located.point.rays > 2) ratios_.push_back(located.point.chi_square / (2 * located.point.rays - 3));
    }
    if (std::ssize(ratios_) < kMinPoints) return false;
    const double median = geometry::median(ratios_);
    double sum = 0;
    int count = 0;
    for (const double ratio : ratios_) {
      if (ratio < kFarOff * median) sum += ratio, ++count;
    }
    // Where a calibration errs more in one place than in another, its tail says more than its mean.
    const auto tail = ratios_.begin() + static_cast<std::ptrdiff_t>(0.9 * static_cast<double>(ratios_.size()));
    std::nth_element(ratios_.begin(), tail, ratios_.end());
    const double ratio = std::max(sum / count, *tail / kTail);
    // The sums of squares hold the blobs' own noise too; where that is small, as it is, their root is the factor to be applied.
    const double required = std::clamp(px_ * std::sqrt(ratio), kMinNoise, kMaxNoise);
    const double fraction = learned_ ? kFraction : 1;
    learned_ = true;
    const double before = px_;
    px_ += fraction * (required - px_);
    return std::abs(px_ - before) > 0.001 * before;
  }

 private:
  static constexpr double kFirst = 0.5, kMinNoise = 0.03, kMaxNoise = 2;  // px
  static constexpr int kMinPoints = 4;                                    // points
  static constexpr double kFarOff = 6;                                    // times the median
  static constexpr double kTail = 2.08;      // by definition: what 90 % of three rays' ratios stay below, of a plain Gaussian
  static constexpr double kFraction = 0.02;  // a frame

  double px_;
  bool given_;
  bool learned_ = false;
  std::vector<double> ratios_;
};

}  // namespace marey::reconstruct
