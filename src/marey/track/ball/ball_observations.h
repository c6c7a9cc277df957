// The data of one instant before the ball is tracked: what each camera saw that might be it, and where people are.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/core/ids.h"
#include "marey/core/time.h"

namespace marey::track::ball {

/// Something small and bright in one camera's image.
struct BallSighting {
  Vector<2> pixel = Vector<2>::Zero();
  double sigma = 0.6;        ///< px, of each coordinate
  double score = 0;          ///< logarithm of how much likelier this appearance is for a ball than for any other detection
  double local_clutter = 0;  ///< 0 … 1: of what is round it, the share that is not the empty scene
  /// By weigh_sightings(); nothing: as many false things as the view has, all over its image.
  std::optional<double> false_density;  ///< 1/px²: how densely things are seen here that are not ball
  bool on_person = false;               ///< where a person's limbs are, which move as predictably as a ball
};

/// What one camera saw at an instant.
struct BallView {
  CameraId camera{};
  Timestamp time{};  ///< of its frame, by the rig's clock
  std::vector<BallSighting> detected;
  std::vector<Box> people;  ///< px; behind or before which the ball is hidden more often than not
};

/// Where on the ground, m, world. An empty function holds everywhere.
using GroundRegion = std::function<bool(const Vector<2>& location)>;

struct BallPerson {
  TrackId id{};
  Vector<2> location = Vector<2>::Zero();  ///< m, world
  Vector<2> velocity = Vector<2>::Zero();  ///< m/s
};

struct BallObservations {
  std::int64_t index = 0;
  Timestamp time{};
  std::vector<BallView> views;
  std::vector<BallPerson> people;
};

}  // namespace marey::track::ball
