// A skeleton: a tree of segments, each hung on its parent by a joint, which coordinates (angles and shifts) move; and where markers
// sit on the segments. One model holds what BVH, ASF, OpenSim and skeleton.toml say: a joint is a sequence of turns and shifts,
// each a function of one coordinate.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "marey/core/body.h"
#include "marey/core/geometry.h"
#include "marey/core/time.h"
#include "marey/geometry/rigid.h"

namespace marey {

/// How far a joint's axis is turned or shifted (rad, m), as a function of a coordinate.
class CoordinateFunction {
 public:
  /// The coordinate itself.
  CoordinateFunction() = default;
  static CoordinateFunction constant(double value) { return linear(0, value); }
  static CoordinateFunction linear(double slope, double offset);
  /// By growing power.
  static CoordinateFunction polynomial(std::vector<double> coefficients);
  /// The cubic spline through these points, x growing, whose third derivative at either end is that of the cubic through the four
  /// points there (Forsythe, Malcolm, Moler 1977, chapter 4): OpenSim's SimmSpline. Beyond its ends it is straight. At least two
  /// points.
  static CoordinateFunction spline(std::vector<double> x, std::vector<double> y);

  /// The same, this many times.
  CoordinateFunction times(double factor) const;
  double value(double x) const;
  double slope(double x) const;
  /// The second derivative.
  double curvature(double x) const;
  /// Slope and offset, where it is a straight line.
  std::optional<std::pair<double, double>> line() const;

 private:
  struct Spline {
    std::vector<double> x, y, b, c, d;  // y + t(b + t(c + t·d)), t from x
  };
  std::variant<std::vector<double>, Spline> function_ = std::vector<double>{0, 1};
  double factor_ = 1;
};

/// One degree of freedom: an angle (rad) or a shift (m).
struct Coordinate {
  /// It follows from another one.
  struct Coupling {
    int to = 0;  ///< index of the coordinate, which itself follows from none
    CoordinateFunction function;
  };

  std::string name;
  bool is_rotation = true;                ///< an angle; otherwise a shift
  double rest = 0;                        ///< where it is when the skeleton rests
  std::optional<double> lowest, highest;  ///< what the joint allows
  bool locked = false;                    ///< it stays at `rest`
  std::optional<Coupling> coupling;

  bool free() const { return !locked && !coupling; }
};

/// One turn or shift of a joint.
struct JointAxis {
  bool is_rotation = true;
  Vector<3> axis = Vector<3>::UnitZ();  ///< of length 1
  CoordinateFunction amount;
  std::optional<int> coordinate;  ///< nothing: the amount at 0, always
};

/// How a segment hangs on its parent: parent_from_segment = parent_from_joint · axes, one after the other · joint_from_segment.
struct Joint {
  Rigid3 parent_from_joint;
  std::vector<JointAxis> axes;
  Rigid3 joint_from_segment;
};

struct Segment {
  std::string name;
  std::optional<int> parent;  ///< its index, which is smaller; a root hangs on the world
  Joint joint;
  std::optional<Vector<3>> end;  ///< m, in its frame: where a segment without children ends
};

/// A marker's place on a segment.
struct SkeletonMarker {
  std::string label;
  int segment = 0;
  Vector<3> position = Vector<3>::Zero();  ///< m, in the segment's frame
  double weight = 1;                       ///< of its squared distance, beside the others'
};

/// World and segments in m, z up.
struct Skeleton {
  std::string name;
  std::vector<Coordinate> coordinates;
  std::vector<Segment> segments;  ///< parents before children
  std::vector<SkeletonMarker> markers;

  std::optional<int> segment(std::string_view name) const;
  std::optional<int> coordinate(std::string_view name) const;
  /// Every coordinate at its rest, those that follow from others accordingly.
  std::vector<double> rest() const;
  /// Sets the coordinates that follow from others.
  void couple(std::span<double> coordinates) const;
};

/// Coordinates over time.
struct SkeletonMotion {
  double rate_hz = 0;  ///< positive
  std::vector<Timestamp> times;
  std::vector<std::vector<double>> rows;  ///< for each time, a value a coordinate
};

/// "free", "ball", "universal", "hinge", "weld", or "custom" for anything else.
std::string_view kind_of(const Skeleton& skeleton, const Joint& joint);

/// Where all segments are: world_from_segment. One value a coordinate.
std::vector<Rigid3> pose_of(const Skeleton& skeleton, std::span<const double> coordinates);

/// A turn as three turns about axes that are perpendicular to each other, one after the other: R = R(a₁, θ₁)·R(a₂, θ₂)·R(a₃, θ₃),
/// rad. Of all triples that say the same the one nearest to `near`; where the second turn brings the first and third axis together,
/// the first stays as it is in `near`.
Vector<3> rotations_about(const Matrix<3>& rotation, const Matrix<3>& axes, const Vector<3>& near);

/// The skeleton as a recording holds it: its segments, with axes that are parallel to the world's at rest. Ids count from 1.
std::vector<Body> bodies_of(const Skeleton& skeleton);
/// Segments' poses as poses of those bodies, given what `rest_of` found.
std::vector<Matrix<3>> rest_of(const Skeleton& skeleton);
Rigid3 body_pose(const Rigid3& world_from_segment, const Matrix<3>& rest);

}  // namespace marey
