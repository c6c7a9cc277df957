// What is told of the ball's way: what was seen well enough that it was the ball, and what lies between.
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

struct BallWayOptions {
  BallSearchOptions search;
  BallClutterOptions clutter;
  BallRestOptions rest;
  double least_evidence = 30;  ///< logarithm: of how much likelier the ball than false things a roll or a flight must be,
  double least_way = 1.5;      ///< and m that it must get
  double as_people = 4;        ///< m/s; what is no faster, or mostly beyond the lines, may be somebody whom nobody detected,
  double least_slow = 120;     ///< and needs that much evidence
  double unseen = 1.5;         ///< s without anybody having seen it well, after which nobody knows where it is,
  double unseen_held = 4;      ///< but where the same person has it all the while
};

/// Where the ball is searched, and what lies within the lines.
struct BallArea {
  GroundRegion possible = {}, pitch = {};
};

/// Where the ball was at each moment, nothing where it is not known: search, smoothing, and what of it is told.
std::vector<std::optional<BallState>> ball_way(std::vector<BallMoment>& moments, const std::shared_ptr<const GroundViews>& views,
                                               const BallArea& area, const BallWayOptions& options,
                                               const std::function<bool()>& stop = {});

}  // namespace marey::track::ball
