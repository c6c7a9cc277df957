// What is reported of the ball's trajectory: clear observations of the ball, and the positions between.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "marey/track/ball/ball_clutter.h"
#include "marey/track/ball/ball_rest.h"
#include "marey/track/ball/ball_smooth.h"

namespace marey::track::ball {

struct BallTrajectoryOptions {
  BallSearchOptions search;
  BallClutterOptions clutter;
  BallRestOptions rest;
  double min_evidence = 30;     ///< logarithm: of how much likelier the ball than false things a roll or a flight must be,
  double min_trajectory = 1.5;  ///< and m that it must get
  double as_people = 4;         ///< m/s; what is no faster, or mostly beyond the lines, may be a person not detected,
  double min_slow = 120;        ///< and needs that much evidence
  double unobserved = 1.5;      ///< s without a good observation, after which its position is unknown,
  double unobserved_held = 4;   ///< but where the same person has it all the while
};

/// Where the ball is searched, and what lies within the lines.
struct BallArea {
  GroundRegion possible = {}, pitch = {};
};

/// Where the ball was at each instant, nothing if it is not known: search, smoothing, and what of it is reported.
std::vector<std::optional<BallState>> ball_trajectory(std::vector<BallObservations>& time_steps,
                                                      const std::shared_ptr<const GroundViews>& views, const BallArea& area,
                                                      const BallTrajectoryOptions& options, const std::function<bool()>& stop = {});

}  // namespace marey::track::ball
