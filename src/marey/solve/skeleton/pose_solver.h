// Inverse kinematics: the pose of a skeleton in which its markers lie nearest to where they were seen.
//
// Each frame minimises Σ w ρ(|p(x) − m|) / σ² + (x − predicted)ᵀ P (x − predicted) + limits over the free coordinates x, by
// Levenberg–Marquardt from the predicted pose. ρ is Geman and McClure's, so that a swapped marker does not drag a limb along; where
// it leaves markers far off, the plain sum of squares is tried as a start too, and what costs less is taken. Derivatives are the
// skeleton's own: a turn about axis a through c moves p by a × (p − c). The normal equations are gathered over the tree (of every
// segment's markers only weight, sum and second moment count, as of a rigid body's mass: Featherstone's composite bodies), so that
// an iteration costs the sum of the depths of the coordinates, and the solution of one small system.
//
// The prediction (constant velocity) holds what no marker shows, and only that. With H the markers' information in units in which 1
// is "just not observed", P = (memory / Δt) (1 + H)⁻²: a direction with information h follows its markers within
// memory / (h (1 + h)²), whatever the frame rate; what is observed is the least-squares solution of this frame alone.
//
// Where markers are hidden, those left say something else than all did together, for none fits exactly (skin, the model). So a
// marker whose segment, or one beside it, misses one is taken to sit where it was found when none was, and ever less so.
//
// The posterior deviation of a coordinate is what this frame's markers alone say of it, given the residuals there are; a forearm's
// turn with one marker has none. Beyond `not_observed_rad` it counts as not observed.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "marey/solve/skeleton/articulation.h"

namespace marey::solve::skeleton {

struct PoseOptions {
  double marker_sigma_m = 0.005;          ///< of a marker, at first; then as the residuals are
  double robust_m = 0.05;                 ///< residuals beyond count less and less; at least 10 σ
  double memory_s = 0.02;                 ///< what is barely observed follows its markers within it
  double velocity_s = 0.01;               ///< over which speeds are averaged
  double noise_s = 0.1;                   ///< over which the markers' σ is
  double away_s = 0.05, hidden_s = 2;     ///< a marker that returns after this long, and not later, has the poses inspected again
  double shift_s = 1;                     ///< within which markers beside hidden ones go back to where the skeleton has them
  double decay_s = 0.1;                   ///< within which an angle that no marker shows comes to rest
  double limit_rad = 0.005;               ///< how far a limit gives way to one σ of a marker
  double not_observed_rad = 0.174532925;  ///< 10°
  double not_observed_m = 0.1;
  int max_iterations = 30;
  double lost_m = 0.12;      ///< where most markers are farther away, it starts again
  double reacquire_s = 0;    ///< and that no sooner than this after the last time
  double at_limit_s = 0.25;  ///< a hinge that stays at its limit for this long is asked whether the limb above it is turned about
};

/// A skeleton at one instant.
struct SolvedPose {
  std::vector<double> coordinates;  ///< rad, m; angles continue over ±π
  std::vector<double> deviations;   ///< of each coordinate; 0 where it is locked
  std::vector<bool> observed;       ///< of each coordinate
  std::vector<Rigid3> world_from_segment;
  std::vector<std::optional<double>> residuals;  ///< m, of each of the skeleton's markers that was seen
  int detected = 0;
  double rms_m = 0;  ///< of the residuals
  int iterations = 0;
  bool started = false;  ///< without a prediction: the first, or it was lost before
};

/// What one frame says of the step from a pose, for those who solve many frames at once: A, b of A·x = b.
struct PoseEquations {
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;
  double cost = 0;  ///< Σ w ρ / σ²
};

class PoseSolver {
 public:
  /// The skeleton must outlive it. Throws Error if it has no markers or nothing that moves.
  explicit PoseSolver(const Skeleton& skeleton, const PoseOptions& options = {});

  /// One instant later by `seconds`; `seen` has a place for each of the skeleton's markers that was seen, m in the world. Valid
  /// until the next call. Nothing is allocated after the first.
  const SolvedPose& step(double seconds, std::span<const std::optional<Vector<3>>> detected);
  /// The next step starts without a prediction.
  void forget() { known_ = false; }
  /// The next step starts from here.
  void start_from(std::vector<double> coordinates);
  /// The pose with these coordinates as this frame's markers see it: nothing is solved, and the next step continues from where the
  /// last one was.
  const SolvedPose& inspect_at(std::vector<double> coordinates, std::span<const std::optional<Vector<3>>> detected);
  const SolvedPose& pose() const { return pose_; }
  double marker_sigma_m() const { return sigma_m_; }

  Articulation& articulation() { return articulation_; }
  const SkeletonState& state() const { return state_; }
  /// Linearises the markers at a state.
  void linearise(const SkeletonState& state, std::span<const std::optional<Vector<3>>> detected, PoseEquations& equations);
  /// How many limbs may lie nearly the same in two poses; and the others of one of them, to start from.
  std::size_t limbs() const { return limbs_.size(); }
  std::vector<SkeletonState> other_poses(std::size_t limb, const SkeletonState& state);
  /// Of markers, limits and how unlike a person's the limbs are folded, in σ² of a marker.
  double cost_of(const SkeletonState& state, std::span<const std::optional<Vector<3>>> detected);
  /// Of each marker: how far it sits from where the skeleton has it, m, on its segment; until frames are solved in turn.
  std::span<Vector<3>> shifts() { return shifts_; }
  /// σ of a marker's coordinate, as all frames of a solved recording together have it; until frames are solved in turn.
  void learn_noise_of(std::span<const std::vector<double>> rows, std::span<const std::vector<std::optional<Vector<3>>>> frames);
  /// Of a pose, in units of what just counts as not observed: the identity in directions that no marker shows, near 0 in others:
  /// (1 + H)⁻². Valid until the next call.
  const Eigen::MatrixXd& openness(const SkeletonState& state, std::span<const std::optional<Vector<3>>> detected);
  /// From a pose to where the markers are; what they leave open stays. Forgets the motion.
  SkeletonState solve_near(const SkeletonState& start, std::span<const std::optional<Vector<3>>> detected);
  /// Adds what pulls coordinates back that are beyond their limits.
  void add_limits(const SkeletonState& state, PoseEquations& equations) const;

 private:
  using Detected = std::span<const std::optional<Vector<3>>>;
  /// Of a segment and all that hang on it: what its markers weigh.
  struct TimeSteps {
    double weight = 0;
    Vector<3> sum = Vector<3>::Zero();
    Matrix<3> second = Matrix<3>::Zero();
    Vector<3> pull = Vector<3>::Zero(), torque = Vector<3>::Zero();
  };

  /// A segment that turns freely, and the hinge with limits at its end: turned by half a turn about itself, with the hinge bent the
  /// other direction, it lies nearly as before.
  struct Limb {
    std::size_t ball = 0;
    int hinge = 0;                ///< coordinate
    std::vector<int> joint_axes;  ///< coordinates of the hinge's joint besides
    Vector<3> along;              ///< in the ball's frame
    Matrix<3> rest;               ///< of the ball
    double at_limit_s = 0;
    std::vector<bool> near;  ///< of each segment: its markers say something of this limb
    bool requested = false;
  };

  void predict(double seconds, Detected detected);
  void find_open(const SkeletonState& state, Detected detected);
  void set_prior(Detected detected, double strength);
  void set_weak_prior();
  double scale_of(int dof) const;
  double solve_frame(Detected detected);
  double least_squares_start(Detected detected);
  double evaluate(const SkeletonState& state, Detected detected);
  double gather_markers(Detected detected);
  void gather(PoseEquations& equations);
  double prior_cost(const SkeletonState& state);
  void add_prior(const SkeletonState& state);
  double limit_cost(const SkeletonState& state) const;
  double minimise(Detected detected, int maximum);
  void cold_start(Detected detected);
  void find_limbs();
  bool at_limit(int coordinate) const;
  double oddness(const Limb& limb) const;
  double cost_of_pose(const Limb& limb, Detected detected);
  std::vector<SkeletonState> rotated_about(const Limb& limb) const;
  bool turn_limbs(Detected detected);
  void mind_limits(double seconds, Detected detected);
  void mind_returns(Detected detected);
  void try_as_it_was(const std::vector<bool>& returned, Detected detected);
  double oddness_of_limbs() const;
  void remember(double seconds, Detected detected);
  void shift_markers(double seconds, Detected detected);
  std::vector<SkeletonState> starts(Detected detected);
  std::optional<Rigid3> root_from(Detected detected, bool root_alone, const SkeletonState& rest);
  double rms_of(Detected detected);
  bool lost() const;
  void learn_noise(Detected detected, double seconds);
  void assess(Detected detected);
  void evaluate_balls();
  void learn_velocity(double seconds);

  Articulation articulation_;
  PoseOptions options_;
  bool known_ = false;
  double since_start_s_ = 0;
  double sigma_m_, robust_m_;
  SkeletonState state_, predicted_, trial_, last_;
  Eigen::VectorXd velocity_, step_, difference_;
  Eigen::MatrixXd prior_information_;
  std::vector<bool> dof_observed_;
  Eigen::VectorXd dof_deviation_;
  std::vector<TimeSteps> time_steps_;
  std::vector<Limb> limbs_;
  std::vector<double> away_s_;  // of each marker: since when it is not seen
  SkeletonState whole_;         // the last pose in which none was missed
  bool returned_ = false;
  std::vector<std::vector<std::size_t>> near_;  // of each segment: itself, its parent and its children
  std::vector<bool> near_missed_;
  std::vector<double> missed_s_;           // of each segment: since when one of the markers near it is hidden
  std::vector<Vector<3>> found_, shifts_;  // of each marker: where it sat, from where the skeleton has it, and is taken to sit
  PoseEquations equations_;
  Eigen::MatrixXd damped_, covariance_;
  Eigen::LDLT<Eigen::MatrixXd> solver_;
  SolvedPose pose_;
  int iterations_ = 0;
};

}  // namespace marey::solve::skeleton
