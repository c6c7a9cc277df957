#pragma once

#include <array>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/geometry.h"
#include "marey/track/contour/colour_patch.h"

namespace marey::track::contour {

/// A target's appearance, learned while no person hides it: the colours of its body from head to foot, and what places about its
/// centre it covers how often. Places are in heights of the target from its centre of area.
class BodyModel {
 public:
  BodyModel();

  /// `share` of each cell of the patch shows the target (CV_32FC1); `rate` in (0, 1] is its weight against the earlier data.
  void learn_colours(const ColourPatch& patch, const cv::Mat& fraction, const Vector<2>& centre, double height, double rate);
  void learn_coverage(const ColourPatch& patch, const cv::Mat& fraction, const Vector<2>& centre, double height, double rate);

  bool knows_colours() const { return known_; }
  /// Probability density of a colour at a place `down` heights below the centre, per level³.
  double density(double down, const cv::Vec3f& colour) const;
  /// How often the place is covered, 0 … 1; before anything is learned, by a person who stands.
  double coverage(const Vector<2>& location) const;

 private:
  static constexpr int kBands = 6, kLuma = 12, kChroma = 12;
  static constexpr int kAcross = 24, kDown = 36;
  using Histogram = std::array<float, kLuma * kChroma * kChroma>;

  bool known_ = false;
  std::vector<Histogram> colours_;  // each sums to 1
  std::array<float, kAcross * kDown> coverage_{};
};

}  // namespace marey::track::contour
