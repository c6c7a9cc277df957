#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/geometry.h"

namespace marey::simulate::markers {

/// A single picture that is hard to find markers in, and where they are.
struct MarkerPicture {
  cv::Mat image;                   ///< CV_8UC1
  std::vector<Vector<2>> markers;  ///< centres, px
  double radius = 0;               ///< of every marker, px
};

/// 640 × 480 px, 3 to 12 bright discs of 2.5 to 7 px before several of: bars of any grey up to a third of the picture wide, a
/// gradient, a vignette, a lamp's glow at the edge, lit texture, saturated streaks; noise of 1 to 4 grey levels, and in every
/// second one JPEG of quality 60 to 95. Discs stand out by 90 grey levels or more from what is behind them, and keep 4 px from each
/// other.
MarkerPicture hard_picture(std::uint64_t seed);

/// A wand as an infrared camera sees it: 1024 × 704 px, two or three saturated markers of 2 to 5 px, some closer to each other than
/// their width and some drawn out by motion, over a room that is lit by 10 to 30 grey levels, with two lamps of 15 to 40 px and
/// specks of 1 to 2 px.
MarkerPicture wand_picture(std::uint64_t seed);

/// `count` dots of 1 to 1.6 px on a grey gradient, 1280 × 1024 px, at least 6 px apart.
MarkerPicture dense_dots(std::uint64_t seed, int count = 2000);

}  // namespace marey::simulate::markers
