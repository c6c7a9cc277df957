// What of a PTZ camera stays (place, lean, roll, nodal offset, bend), from several of its frames together: clicks, and paint
// once it is found. One frame alone leaves place and focal length open against each other; frames that face different sides
// hold the place. Priors are wide, what main cameras have in common (upright within half a degree, lens nearly straight).
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core/types.hpp>

#include "marey/calibrate/ptz/initial_tripod.h"
#include "marey/calibrate/ptz/line_markings.h"
#include "marey/calibrate/ptz/ptz_fit.h"
#include "marey/geometry/tripod.h"

namespace marey::calibrate::ptz {

/// One frame of those that are solved together.
struct TripodFrameSight {
  geometry::Heading heading;
  std::vector<PaintSighting> paint;
  std::vector<ClickedPosition> clicks;
};

/// Where the tripod is known to stand about, m.
struct LocationPrior {
  Vector<3> location = Vector<3>::Zero(), sigma = Vector<3>::Ones();
};

struct TripodSolveOptions {
  double click_px = 2.5;                    ///< how well people click, of 1280 px across
  double lean_sigma = 0.01;                 ///< rad
  double roll_sigma = 0.01;                 ///< rad
  double ahead = 0.15, ahead_sigma = 0.15;  ///< m
  double bend = 0.01, bend_sigma = 0.03;    ///< per half image width squared
  double per_line = 8;                      ///< samples of one line in one frame err together
  std::optional<LocationPrior> near;        ///< nothing: anywhere
};

struct TripodSolution {
  geometry::Tripod tripod;
  std::vector<geometry::Heading> headings;  ///< one a frame
  double cost = 0;
  Matrix<geometry::Tripod::numbers> covariance;  ///< of the tripod's numbers, the headings left free
};

/// Refines a tripod and the headings of its frames on all that is seen in them, with a robust loss.
TripodSolution solve_tripod(const geometry::Tripod& start, std::span<const TripodFrameSight> frames, cv::Size size,
                            const TripodSolveOptions& options = {});

/// How a tripod came out of clicks alone.
struct ClickedTripod {
  geometry::Tripod tripod;
  std::vector<geometry::Heading> headings;
  bool reflected = false;    ///< the clicks' frame is left-handed: the world's y is the pitch's width less theirs
  bool either_hand = false;  ///< the clicks fit a frame of the other hand as well: they lie on one line
  Matrix<geometry::Tripod::numbers> covariance;  ///< of the tripod's numbers
  std::vector<std::vector<double>> error_px;     ///< for each frame and click
  double median_px = 0;
};

/// Throws Error if clicks are too few, do not fit a camera, or one frame's belong to the other half of the pitch. `clicks` are
/// in the pitch's own frame: x along a touchline from one corner, y along the goal line, of either hand.
ClickedTripod tripod_from_clicks(const std::vector<ClickedFrame>& clicks, cv::Size size, const geometry::PitchSize& pitch,
                                 const TripodSolveOptions& options = {});

}  // namespace marey::calibrate::ptz
