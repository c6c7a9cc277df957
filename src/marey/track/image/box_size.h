// The size of a target's box over time, kept apart from its motion. A person's height and width change slowly; a box that
// suddenly grows has swallowed a neighbour, one that suddenly shrinks is partly hidden. Such a box is not trusted: the target
// keeps its size, and its place is read from the box's edges that still fit (after Xu, Orwell, Lowey, Thirde, "Architecture and
// algorithms for tracking football players with multiple cameras", IEE Proc. Vis. Image Signal Process. 152(2), 2005). Only a box
// that keeps its new size for a while, alone, is trusted after all.
//
// Each axis is a scalar Kalman filter of the logarithm (a size is positive, and errs by a share of itself) that drifts as a
// random walk.
#pragma once

#include <algorithm>
#include <cmath>

#include "marey/core/geometry.h"

namespace marey::track::image {

struct BoxSizeOptions {
  double noise = 0.08;          ///< of the logarithm of one measured side, standard deviation
  double drift = 0.15;          ///< of the logarithm in a second, standard deviation
  double jump_sigmas = 3;       ///< a side that differs by more is not trusted
  double change_of_mind = 0.7;  ///< s that a contradicting side must persist to be trusted after all
};

class BoxSide {
 public:
  BoxSide(double side, const BoxSizeOptions& options) : log_(std::log(side)), variance_(options.noise * options.noise) {}

  void predict(double dt, const BoxSizeOptions& options) {
    variance_ += options.drift * options.drift * dt;
    if (contradicted_ > 0) contradicted_ += dt;
  }

  double side() const { return std::exp(log_); }

  /// Squared distance of a measured side, in variances.
  double distance(double side, const BoxSizeOptions& options) const {
    const double residual = std::log(side) - log_;
    return residual * residual / (variance_ + options.noise * options.noise);
  }

  bool trusts(double side, const BoxSizeOptions& options) const {
    return distance(side, options) <= options.jump_sigmas * options.jump_sigmas;
  }

  /// Takes in a measured side, and says whether it was trusted.
  bool correct(double side, const BoxSizeOptions& options) {
    constexpr double just_now = 1e-9;
    if (!trusts(side, options)) {
      contradicted_ = std::max(contradicted_, just_now);
      if (contradicted_ < options.change_of_mind) return false;
      variance_ = 1;
    }
    const double gain = variance_ / (variance_ + options.noise * options.noise);
    log_ += gain * (std::log(side) - log_);
    variance_ *= 1 - gain;
    contradicted_ = 0;
    return true;
  }

 private:
  double log_;
  double variance_;
  double contradicted_ = 0;  // s since a side was first not trusted; 0 for none
};

class BoxSize {
 public:
  BoxSize(const Box& box, const BoxSizeOptions& options) : width_(box.width, options), height_(box.height, options) {}

  void predict(double dt, const BoxSizeOptions& options) {
    width_.predict(dt, options);
    height_.predict(dt, options);
  }

  double width() const { return width_.side(); }
  double height() const { return height_.side(); }
  Box around(const Vector<2>& centre) const { return Box::from_centre(centre, width(), height()); }

  bool trusts(const Box& box, const BoxSizeOptions& options) const {
    return width_.trusts(box.width, options) && height_.trusts(box.height, options);
  }

  /// Squared distance of a box's size, two degrees of freedom.
  double distance(const Box& box, const BoxSizeOptions& options) const {
    return width_.distance(box.width, options) + height_.distance(box.height, options);
  }

  void correct(const Box& box, const BoxSizeOptions& options) {
    width_.correct(box.width, options);
    height_.correct(box.height, options);
  }

  /// The place nearest to `expected` for the centre of a target of this size that lies somewhere in `region`.
  Vector<2> centre_within(const Box& region, const Vector<2>& expected) const {
    const Vector<2> slack(std::max(0.0, region.width - width()) / 2, std::max(0.0, region.height - height()) / 2);
    return expected.cwiseMax(region.centre() - slack).cwiseMin(region.centre() + slack);
  }

  /// Where `seen` puts the centre of a target of this size that is expected at `expected`: the middle where a side is trusted,
  /// else the edge that moved less.
  Vector<2> centre_in(const Box& detected, const Vector<2>& expected, const BoxSizeOptions& options) const {
    const Vector<2> middle = detected.centre();
    return {width_.trusts(detected.width, options) ? middle.x() : anchored(middle.x(), detected.width, expected.x(), width()),
            height_.trusts(detected.height, options) ? middle.y() : anchored(middle.y(), detected.height, expected.y(), height())};
  }

 private:
  static double anchored(double middle, double seen_side, double expected, double side) {
    const double by_low_edge = middle - seen_side / 2 + side / 2;
    const double by_high_edge = middle + seen_side / 2 - side / 2;
    const double low = std::min(by_low_edge, by_high_edge);
    const double high = std::max(by_low_edge, by_high_edge);
    // A larger box holds the target somewhere between the two; of a smaller one the nearer edge is the target's own.
    if (seen_side > side) return std::clamp(expected, low, high);
    return std::abs(by_low_edge - expected) < std::abs(by_high_edge - expected) ? by_low_edge : by_high_edge;
  }

  BoxSide width_;
  BoxSide height_;
};

}  // namespace marey::track::image
