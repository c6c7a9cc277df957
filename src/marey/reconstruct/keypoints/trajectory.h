// A keypoint's path through space from all half-lines of all instants at once: what a network sees trembles from frame to frame,
// and a person's mass does not.
//
// Minimises Σ ρ(e) over all reprojection errors e in standard deviations, and a prior of motion: velocity is a random walk of
// density `agility`. ρ is Geman and McClure's, so that points far off decide nothing. Gauss and Newton's method: errors are
// linearised and weighed at the last path, and a Kalman filter with Rauch, Tung and Striebel's smoother solves the linear problem
// exactly, covariances included. An instant with one half-line says what it can. Assumed: errors of different instants are
// independent, which a lasting bias is not; see `lasting` below. Cost: about 10 µs an instant.
// References: Rauch, Tung, Striebel, AIAA J. 3 (1965); Bell, "The iterated Kalman smoother as a Gauss–Newton method", 1994.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/reconstruct/sight_line.h"

namespace marey::reconstruct::keypoints {

/// The half-lines to one keypoint, instant by instant.
class PointLines {
 public:
  void add(const SightLine& line) { lines_.push_back(line); }
  void end_instant() { ends_.push_back(lines_.size()); }

  std::size_t instants() const { return ends_.size(); }
  std::span<const SightLine> at(std::size_t instant) const {
    const std::size_t begin = instant == 0 ? 0 : ends_[instant - 1];
    return std::span(lines_).subspan(begin, ends_[instant] - begin);
  }

 private:
  std::vector<SightLine> lines_;
  std::vector<std::size_t> ends_;
};

struct TrajectoryOptions {
  double agility_m2_s3 = 12;  ///< by how much a velocity's square changes in a second; sweep: docs/markerless_space.md
  double bound = 3;           ///< standard deviations at which an error has a quarter of its weight
  int rounds = 5;
};

struct TrajectoryPoint {
  Vector<3> position = Vector<3>::Zero(), velocity = Vector<3>::Zero();  ///< m, m/s
  Matrix<3> covariance = Matrix<3>::Identity();                          ///< m²
  std::uint64_t cameras = 0;                                             ///< whose half-lines have a say
  int rays = 0;                                                          ///< how many
  double residual_px = 0;                                                ///< root mean square of their errors
};

/// The path over all instants, `step_s` apart. `start` is about where the point is, where that is known; at least at one instant,
/// else the result is empty.
std::vector<TrajectoryPoint> smooth_trajectory(const PointLines& lines, std::span<const std::optional<Vector<3>>> start,
                                               double step_s, const TrajectoryOptions& options = {});

/// The squared errors of all half-lines, in standard deviations, one after the other: of errors as stated the median is 1.39.
void append_squares(const PointLines& lines, std::span<const TrajectoryPoint> path, std::vector<double>& squares);

}  // namespace marey::reconstruct::keypoints
