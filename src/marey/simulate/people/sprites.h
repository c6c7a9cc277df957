#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include <opencv2/core/mat.hpp>

#include "marey/core/geometry.h"
#include "marey/core/image.h"
#include "marey/simulate/people/figure.h"
#include "marey/simulate/people/silhouette_raster.h"

namespace marey::simulate::people {

/// Y, Cb, Cr as BT.601 codes them in limited range, not rounded.
using Ycc = std::array<float, 3>;

Ycc to_ycc(const Rgb& rgb, double factor);

/// Rounded.
inline std::uint8_t clamp_level(float level) {
  return static_cast<std::uint8_t>(std::clamp(level + 0.5F, 0.0F, 255.0F));
}

/// The blocks of 2 × 2 pixels that a rectangle touches.
cv::Rect half_of(const cv::Rect& pixels);

/// What video is made of: one luma a pixel, one of each chroma a block of 2 × 2.
struct Planes {
  cv::Mat luma, cb, cr;
};

/// A figure or a post, drawn alone.
struct Sprite {
  double depth = 0;
  Silhouette shape;  ///< values are indices of `palette`
  std::array<Ycc, 256> palette{};

  /// Mixes it into the planes: by pixels for luma, by 2 × 2 pixels for chroma.
  void lay(Planes& planes) const;
  /// Whether it shows at this point, px.
  bool covers(const Vector<2>& at) const;
};

/// A ball that is played with: a disc, smeared along its path while the shutter is open.
struct BallSprite {
  double depth = 0;
  Vector<2> from = Vector<2>::Zero(), to = Vector<2>::Zero();  ///< px
  double radius = 0;                                           ///< px
  Ycc colour{};

  Vector<2> middle() const { return (from + to) / 2; }
  /// What a pixel keeps of the scene is the share of time and area that the disc does not cover; light comes from above.
  void lay(Planes& planes) const;
};

}  // namespace marey::simulate::people
