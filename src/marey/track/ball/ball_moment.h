// What is known of one moment before the ball is followed: what each camera saw that might be it, and where people are.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/core/ids.h"
#include "marey/core/time.h"

namespace marey::track::ball {

/// Something small and bright in one camera's picture.
struct BallSighting {
  Vector<2> pixel = Vector<2>::Zero();
  double sigma = 0.6;  ///< px, of each coordinate
  double score = 0;    ///< logarithm of how much likelier a ball looks so than anything else that is found
};

/// What one camera saw at a moment.
struct BallView {
  CameraId camera{};
  Timestamp time{};  ///< of its frame, by the rig's clock
  std::vector<BallSighting> seen;
  std::vector<Box> people;  ///< px; behind or before which the ball is hidden more often than not
};

struct BallPerson {
  TrackId id{};
  Vector<2> place = Vector<2>::Zero();     ///< m, world
  Vector<2> velocity = Vector<2>::Zero();  ///< m/s
};

struct BallMoment {
  std::int64_t index = 0;
  Timestamp time{};
  std::vector<BallView> views;
  std::vector<BallPerson> people;
};

}  // namespace marey::track::ball
