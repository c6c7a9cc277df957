#pragma once

#include <map>
#include <optional>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/core/ground_transform.h"
#include "marey/core/recording.h"
#include "marey/core/rig.h"
#include "marey/geometry/pitch.h"

namespace marey::reconstruct {

/// The part of the ground whose people count: a pitch, or any polygon, with a margin round it, in the user's frame. Without either
/// all of it.
class GroundArea {
 public:
  GroundArea() = default;

  /// The pitch's corner is the origin of the user's frame, which is the world through `ground_from_world`. `margin` in m.
  GroundArea(const std::optional<Matrix<3>>& ground_from_world, const std::optional<geometry::PitchSize>& pitch, double margin);

  /// Within the polygon of these corners, m in the user's frame, in order round it: three or more, or none for everywhere. Throws
  /// Error for one or two.
  GroundArea(const std::optional<Matrix<3>>& ground_from_world, std::vector<Vector<2>> corners, double margin);

  /// The user's coordinates of a place in the world, and a velocity's.
  Vector<2> ground(const Vector<2>& world) const;
  Vector<2> ground_velocity(const Vector<2>& velocity) const;
  Vector<2> world(const Vector<2>& ground) const;
  /// The same for a whole recording. This must outlive it.
  GroundChange change() const;

  /// Whether a person at this place of the world counts; with `slack` m more on all sides.
  bool holds(const Vector<2>& world, double slack = 0) const;

  /// Whether the user's frame is seen as in a mirror from above: y to the right of x.
  bool mirrored() const { return is_reflection(ground_from_world_); }
  const std::optional<geometry::PitchSize>& pitch() const { return pitch_; }
  /// Whether people count on a part of the ground only.
  bool bounded() const { return pitch_ || !corners_.empty(); }
  double margin() const { return margin_; }

 private:
  Matrix<3> ground_from_world_ = Matrix<3>::Identity(), world_from_ground_ = Matrix<3>::Identity();
  std::optional<geometry::PitchSize> pitch_;
  std::vector<Vector<2>> corners_;  // of the polygon; of a pitch its four
  double margin_ = 0;
};

/// A recording of those who count.
struct KeptPeople {
  Recording recording;
  std::map<TrackId, TrackId> now;  ///< what each track that is kept is called
};

/// Omits places that do not count, and who was nowhere else; the others are numbered again from 1, by their first instant. What
/// is kept is in the user's frame of reference. `recording` is of the world's ground and used up track by track. Throws Error for
/// another frame.
KeptPeople people_in(const GroundArea& area, Recording recording);

}  // namespace marey::reconstruct
