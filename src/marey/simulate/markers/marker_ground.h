#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/geometry.h"
#include "marey/simulate/random.h"

namespace marey::simulate::markers {

/// An image of markers while it is made.
struct MarkerStage {
  Random random;
  std::uint64_t seed;
  cv::Mat ground;                 ///< CV_32FC1, levels of 255
  double base = 18;               ///< level of the empty ground
  double quantizer = 0;           ///< of compression; 0: none
  std::vector<Vector<2>> specks;  ///< px

  /// Anywhere but within `margin` px of the border.
  Vector<2> location(double margin);
};

// What is laid over the ground before there are markers.

/// A bar `width` px wide through the image's middle part, at any angle.
void lay_bar(MarkerStage& stage, double width, double level);
/// This many areas of one level each, up to 120.
void lay_levels(MarkerStage& stage, int areas);
/// A lit part with bumps of all sizes.
void lay_texture(MarkerStage& stage);
/// This many spots of 2 to 4 px, that stand out by `least` to `most` levels.
void strew_specks(MarkerStage& stage, int count, double minimum = 7, double maximum = 40);
/// The ground rises by this many levels from one side to the other.
void lay_gradient(MarkerStage& stage, double rise);
/// A lit ground that falls off towards the corners.
void lay_vignette(MarkerStage& stage);
/// A lamp and the light that the lens spreads round it: a saturated core and a halo that falls off by e in a few tens of pixels.
void lay_lamp(MarkerStage& stage, const Vector<2>& at, double radius);
/// One or two lamps at or beyond the image's edge.
void lay_glow(MarkerStage& stage);
/// Light on metal: a chain of saturated ellipses of all sizes.
void lay_reflection(MarkerStage& stage);

}  // namespace marey::simulate::markers
