// Rigid bodies followed through points in space, live: what is reported of an instant needs nothing that comes after it.
//
// Each body is predicted with the velocity and the turning rate it had. Markers are searched for near where they are then due,
// within what the prediction may be off; points are shared out among the markers of all bodies at once, so that two bodies that
// pass each other do not take each other's. Three markers or more, not in a line, give the pose: what is reported is the most
// probable one of this instant alone. With two or one the prediction is corrected and reported as predicted, with the rest unknown
// of it; with none it continues, up to `predict_s`. Bodies that are not there are searched for among the points that no other body
// has (body_initialisation.h); identical ones are distinguished by where each was last. A body that appears the same after a turn
// has as many possible poses. They are distinguished by continuity: when it comes back out of hiding, by its predicted pose; an
// instant later, when its turning rate is known again, by the mean of the rates before and after, or by a body that carries it
// (hidden_rotation.h). A decision that turns out wrong is corrected, and said (`Correction`); where another pose stays possible, it
// is reported beside the probable one (`BodyPose::other`) from then on. Where markers differ by little, what they add up to over
// many instants decides. Cost: a few µs a body and instant. Memory: bounded by bodies and points.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "marey/assign/gated_assignment.h"
#include "marey/core/body.h"
#include "marey/core/time.h"
#include "marey/solve/bodies/body_initialisation.h"
#include "marey/solve/bodies/body_motion.h"
#include "marey/solve/bodies/hidden_rotation.h"
#include "marey/solve/bodies/pose_fit.h"
#include "marey/solve/bodies/symmetry.h"

namespace marey::solve::bodies {

struct TrackingOptions {
  double tolerance = 0.004;           ///< m: farther from its place no marker is the body's
  std::optional<double> noise;        ///< m: standard deviation of a point along each axis; nothing: learned from how markers fit
  double acceleration = 30;           ///< m/s², standard deviation of a body's
  double angular_acceleration = 150;  ///< rad/s²
  double predict_s = 0.5;             ///< this long a body is reported without three of its markers
  double by_chance = 1e-4;  ///< this many like it to be expected by chance among the points: no body is found (docs/bodies.md)
  double fastest = 15;      ///< m/s: a body is not found again farther away than that allows
};

struct BodyTrackPoint {
  Vector<3> position = Vector<3>::Zero();     ///< m
  std::optional<std::pair<int, int>> marker;  ///< whose its label says it is: the body's and its marker's index
};

/// Which of the poses in which it appears the same a body has since it came back out of hiding, as far as can be said by now.
struct Correction {
  BodyId body{};
  Timestamp since{};
  Rigid3 reported_from_body;       ///< the pose is the reported one times this
  std::optional<OtherPose> other;  ///< as it is then to be reported, but in the body's frame; nothing: none is in question
  double ambiguity = 0;            ///< the probability that this return was decided wrong, where it is in question
  std::string words;               ///< of such a doubt: how the other pose differs
};

/// What results from following one body.
struct TrackCounts {
  std::int64_t measured = 0, predicted = 0, absent = 0;  ///< instants
  std::int64_t lost = 0;                                 ///< times it was given up after it had been followed
  std::int64_t corrected = 0;                            ///< times it was found to be turned by a symmetry
  std::int64_t in_question = 0;                          ///< times it came back, and two of its poses were possible
};

class BodyTracker {
 public:
  // After this time a turning rate is known again, and a return is decided.
  static constexpr int kSettled = 8;              ///< instants
  static constexpr double kSettledS = 0.04;       ///< s, at least
  static constexpr int kSlowlySettled = 4;        ///< instants, at few a second,
  static constexpr double kSlowlySettledS = 0.2;  ///< and s

  /// Throws Error for a body with fewer than three markers, or with all in a line.
  BodyTracker(std::vector<Body> bodies, const TrackingOptions& options = {});

  /// Instants come in growing order of time. By body, those of which something is known; valid until the next call.
  std::span<const BodyPose> step(Timestamp now, std::span<const BodyTrackPoint> points);
  /// Of the last step.
  std::span<const Correction> corrections() const { return corrections_; }
  /// By point of the last step: the body and its marker that it was found to be.
  std::span<const std::optional<std::pair<int, int>>> owners() const { return owner_; }
  /// By body, in the order given.
  const std::vector<TrackCounts>& counts() const { return counts_; }
  const std::vector<Body>& bodies() const { return bodies_; }
  double noise() const { return noise_; }  ///< m, as given or learned by now

 private:
  /// A body that came back out of hiding, as long as its turning rate is not known again.
  struct Return {
    ObservedRotation before, after;  ///< when it was seen last (where that was for an instant only, before it), and first
    int detected = 0;                ///< instants since
  };
  struct Tracked {
    std::vector<Vector<3>> locations;
    std::vector<Symmetry> rotations;
    double shortest_edge = 0, reach = 0;  ///< m: of two markers; from the origin to the farthest one
    std::optional<BodyMotion> motion;     ///< nothing before it was found first
    Timestamp observed_at{};              ///< three markers or more
    Rigid3 observed_pose;
    ObservedRotation observed;    ///< of a body with symmetries
    std::vector<double> rotated;  ///< by turn, the probability that it is turned so against what is reported
    bool present = false;         ///< reported at the last instant
    std::vector<int> point_of;    ///< by marker, this instant; or kNoIndex
    std::optional<PoseFit> fit;   ///< this instant's
    bool measured = false;
    bool labelled = false;  ///< by its markers' names
    std::optional<Return> back;
    std::optional<HiddenRotation> hidden;
    std::vector<double> evidence;  ///< by turn: log-likelihood ratio that the body is turned so
  };

  void predict(Timestamp now);
  void take_labelled(std::span<const BodyTrackPoint> points);
  void search_near(std::span<const BodyTrackPoint> points);
  void settle_near(int body, std::span<const BodyTrackPoint> points);
  bool measure(int body, std::span<const BodyTrackPoint> points, std::vector<int> candidates);
  void search_everywhere(Timestamp now, std::span<const BodyTrackPoint> points);
  void accept(int body, std::span<const BodyTrackPoint> points, const PoseCandidate& candidate, std::span<const int> names);
  ObservedRotation observed_rotation(int body, Timestamp now) const;
  static ObservedRotation last_sure(const Tracked& body) { return body.back ? body.back->before : body.observed; }
  Matrix<3> due(int body) const;
  Rigid3 nearest_turn(const Tracked& body, Rigid3 pose, const Matrix<3>& due) const;
  std::optional<OtherPose> other_of(const Tracked& body, const Rigid3& pose) const;
  void turn_body(int body, const Symmetry& turn);
  void weigh_rotations(int body, Timestamp now, std::span<const BodyTrackPoint> points);
  void evaluate_return(int body, Timestamp now);
  void report(Timestamp now);
  double gate(const Tracked& body, int marker) const;
  void learn_noise(const PoseFit& fit, std::size_t markers);

  std::vector<Body> bodies_;
  TrackingOptions options_;
  std::vector<Tracked> tracked_;
  BodyInitialiser initialise_;
  assign::GatedAssigner assigner_;
  std::vector<assign::GatedPair> pairs_;
  std::vector<std::optional<std::pair<int, int>>> owner_;
  std::vector<BodyPose> poses_;
  std::vector<Correction> corrections_;
  std::vector<TrackCounts> counts_;
  std::optional<Timestamp> last_;
  double shortest_step_s_ = 1;  // between instants: what lies farther apart was hidden, or omitted
  double noise_ = 0, squares_ = 0, freedoms_ = 0;
  int next_initialise_ = 0;  // bodies are searched for in turn
};

}  // namespace marey::solve::bodies
