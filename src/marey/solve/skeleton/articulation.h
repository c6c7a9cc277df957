// A skeleton made ready to be solved: which coordinates are free, and how each moves every segment at the pose it is in. Joints
// that turn about three perpendicular axes keep their rotation itself and move by small turns about the segment's own axes, so that
// no pose is singular; angles are taken out of it at the end. Other joints move by their coordinates.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "marey/core/skeleton.h"

namespace marey::solve::skeleton {

/// Where a skeleton is: its coordinates, and of joints that turn freely the rotations.
struct SkeletonState {
  std::vector<double> coordinates;
  std::vector<Matrix<3>> balls;
};

/// How a point of a segment and of all that hang on it moves with one degree of freedom: turn × p + shift, p in the world.
struct Driver {
  int dof = 0;
  Vector<3> turn = Vector<3>::Zero(), shift = Vector<3>::Zero();
};

class Articulation {
 public:
  /// The skeleton must outlive it.
  explicit Articulation(const Skeleton& skeleton);

  struct Dof {
    std::optional<int> coordinate;  ///< index; nothing if it is a turn of a ball
    int ball = -1, part = 0;        ///< index of the ball, and which of its three small turns
    bool is_rotation = true;
  };
  /// A joint that turns freely.
  struct Ball {
    int segment = 0, first_dof = 0;
    std::array<int, 3> coordinates{};
    Matrix<3> axes;  ///< its turns' axes, as columns
    Vector<3> signs = Vector<3>::Ones();
  };

  const Skeleton& skeleton() const { return *skeleton_; }
  int dofs() const { return static_cast<int>(dofs_.size()); }
  const std::vector<Dof>& dof() const { return dofs_; }
  const std::vector<Ball>& balls() const { return balls_; }

  SkeletonState state_of(std::vector<double> coordinates) const;
  /// `state` moved by a step in every degree of freedom.
  void move(const SkeletonState& state, const Eigen::VectorXd& step, SkeletonState& moved) const;
  /// The step from one state to another.
  void difference(const SkeletonState& from, const SkeletonState& to, Eigen::VectorXd& step) const;
  /// Writes the balls' rotations into the coordinates, as the angles that are nearest to those there.
  void take_angles(SkeletonState& state) const;
  /// Where all segments are, and how they move.
  void location(const SkeletonState& state);

  const std::vector<Rigid3>& world_from_segment() const { return world_from_; }
  /// Of a segment's own joint.
  std::span<const Driver> drivers(std::size_t segment) const {
    return std::span(drivers_).subspan(first_driver_[segment], first_driver_[segment + 1] - first_driver_[segment]);
  }

  /// The state in which the root stands there, where its joint is free to do so.
  std::optional<SkeletonState> with_root_at(const SkeletonState& state, const Rigid3& world_from_root) const;

 private:
  void find_ball(int segment, const Joint& joint);
  double amount(const JointAxis& axis, const SkeletonState& state) const;

  const Skeleton* skeleton_;
  std::vector<Dof> dofs_;
  std::vector<Ball> balls_;
  std::vector<int> dof_of_coordinate_;  // −1: locked, or of a ball
  std::vector<int> ball_of_segment_;    // −1: none
  std::vector<Rigid3> world_from_;
  std::vector<Driver> drivers_;
  std::vector<std::size_t> first_driver_;
};

}  // namespace marey::solve::skeleton
