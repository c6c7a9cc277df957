// Where a camera on a tripod may stand and be aimed, from places of the pitch that were clicked in a few of its frames.
//
// For an assumed place of the tripod, upright, two clicks of a frame give the rest: their angle seen from there the focal length,
// and then pan and tilt (Chen, Zhu & Little, "A two-point method for PTZ camera calibration in sports", WACV 2018). Places all
// round the pitch and over it are tried, at the heights of stands, and evaluated by all clicks of all frames.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core/types.hpp>

#include "marey/core/geometry.h"
#include "marey/geometry/pitch.h"
#include "marey/geometry/tripod.h"

namespace marey::calibrate::ptz {

/// A place on the pitch and where it is seen.
struct ClickedPosition {
  Vector<2> ground = Vector<2>::Zero();  ///< m
  Vector<2> pixel = Vector<2>::Zero();
  std::string name;  ///< as the user wrote it
};

/// What was clicked in one frame.
struct ClickedFrame {
  std::int64_t frame = 0;
  std::vector<ClickedPosition> locations;
};

struct TripodGuess {
  geometry::Tripod tripod;
  std::vector<geometry::Heading> headings;  ///< one a frame
  double cost = 0;                          ///< mean of the distances, px, each cut off
};

/// The best guesses, at most `count`, that stand apart from each other; the best first. Places in a right-handed world, z up.
std::vector<TripodGuess> tripod_starts(std::span<const ClickedFrame> frames, cv::Size size, const geometry::PitchSize& pitch,
                                       std::size_t count);

}  // namespace marey::calibrate::ptz
