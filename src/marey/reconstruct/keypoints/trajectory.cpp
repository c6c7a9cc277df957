#include "marey/reconstruct/keypoints/trajectory.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "marey/filter/bridge.h"
#include "marey/filter/smoother.h"

namespace marey::reconstruct::keypoints {
namespace {

using State = Vector<6>;
using StateMatrix = Matrix<6>;

constexpr double kAnywhere_m = 5, kAnySpeed_m_s = 5;  // deviations before the first instant
constexpr double kHasReport = 0.25;                   // weight

/// What an instant's half-lines say near a place: information and gradient.
struct Evidence {
  Matrix<3> information = Matrix<3>::Zero();
  Vector<3> gradient = Vector<3>::Zero();
};

double weight_of(double square, double bound) {
  const double fraction = bound * bound / (bound * bound + square);
  return fraction * fraction;
}

Evidence evidence_of(std::span<const SightLine> lines, const Vector<3>& at, double bound) {
  Evidence evidence;
  for (const SightLine& line : lines) {
    const double depth = line.depth(at);
    if (!(depth > 0.1)) continue;
    const Vector<2> error = line.error(at) / line.sigma;
    const Eigen::Matrix<double, 2, 3> J = (line.across / line.sigma - error * line.direction.transpose()) / depth;
    const double weight = weight_of(error.squaredNorm(), bound);
    evidence.information.noalias() += weight * J.transpose() * J;
    evidence.gradient.noalias() += weight * J.transpose() * error;
  }
  return evidence;
}

/// Between known places on a straight line, before and after them at rest.
std::vector<Vector<3>> filled(std::span<const std::optional<Vector<3>>> start) {
  std::vector<Vector<3>> path(start.size());
  std::optional<std::size_t> last;
  for (std::size_t i = 0; i < start.size(); ++i) {
    if (!start[i]) continue;
    for (std::size_t j = last ? *last + 1 : 0; j < i; ++j) {
      const double fraction = last ? static_cast<double>(j - *last) / static_cast<double>(i - *last) : 1;
      path[j] = last ? Vector<3>((1 - fraction) * *start[*last] + fraction * *start[i]) : *start[i];
    }
    path[i] = *start[i];
    last = i;
  }
  for (std::size_t j = last ? *last + 1 : start.size(); j < start.size(); ++j) path[j] = *start[*last];
  return path;
}

/// Places and velocities along three axes.
filter::Transition<6> step_of(double seconds, double agility) {
  const filter::Transition<2> axis = filter::WhiteAcceleration{.noise = std::sqrt(agility)}.over(seconds);
  filter::Transition<6> step;
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 2; ++column) {
      step.F.block<3, 3>(3 * row, 3 * column) = axis.F(row, column) * Matrix<3>::Identity();
      step.Q.block<3, 3>(3 * row, 3 * column) = axis.Q(row, column) * Matrix<3>::Identity();
    }
  }
  return step;
}

class TrajectorySmoother {
 public:
  TrajectorySmoother(const PointLines& lines, double step_s, const TrajectoryOptions& options)
      : lines_(lines), step_(step_of(step_s, options.agility_m2_s3)), bound_(options.bound) {}

  /// One step of Gauss and Newton from a path.
  void solve(std::span<const Vector<3>> path) {
    forward(path);
    states_ = smoother_.smoothed();
  }
  const State& state(std::size_t i) const { return states_[i].mean; }
  const StateMatrix& P(std::size_t i) const { return states_[i].covariance; }

 private:
  void forward(std::span<const Vector<3>> path) {
    State state = State::Zero();
    state.head<3>() = path[0];
    StateMatrix P = StateMatrix::Zero();
    P.diagonal() << Vector<3>::Constant(kAnywhere_m * kAnywhere_m), Vector<3>::Constant(kAnySpeed_m_s * kAnySpeed_m_s);
    for (std::size_t i = 0; i < path.size(); ++i) {
      if (i > 0) {
        state = step_.F * state;
        P = step_.F * P * step_.F.transpose() + step_.Q;
      }
      const filter::Estimate<6> expected{state, P};
      const Evidence evidence = evidence_of(lines_.at(i), path[i], bound_);
      const Matrix<3> inner = (Matrix<3>::Identity() + evidence.information * P.topLeftCorner<3, 3>()).inverse();
      const Vector<3> pull = evidence.information * (path[i] - state.head<3>()) - evidence.gradient;
      const Eigen::Matrix<double, 6, 3> across = P.leftCols<3>();
      state += across * (inner * pull);
      const StateMatrix less = across * (inner * evidence.information) * across.transpose();
      P -= 0.5 * (less + less.transpose());
      smoother_.add(step_.F, expected, {state, P});
    }
  }

  const PointLines& lines_;
  filter::Transition<6> step_;
  double bound_;
  filter::Smoother<6> smoother_;
  std::vector<filter::Estimate<6>> states_;
};

void count_rays(std::span<const SightLine> lines, double bound, TrajectoryPoint& point) {
  double sum = 0;
  for (const SightLine& line : lines) {
    if (!(line.depth(point.position) > 0.1)) continue;
    const double square = line.error(point.position).squaredNorm();
    if (weight_of(square / (line.sigma * line.sigma), bound) < kHasReport) continue;
    sum += square;
    ++point.rays;
    point.cameras |= std::uint64_t{1} << line.camera;
  }
  if (point.rays > 0) point.residual_px = std::sqrt(sum / point.rays);
}

}  // namespace

std::vector<TrajectoryPoint> smooth_trajectory(const PointLines& lines, std::span<const std::optional<Vector<3>>> start,
                                               double step_s, const TrajectoryOptions& options) {
  const bool known = std::any_of(start.begin(), start.end(), [](const auto& location) { return location.has_value(); });
  if (!known || lines.instants() == 0) return {};
  std::vector<Vector<3>> path = filled(start);
  TrajectorySmoother smoother(lines, step_s, options);
  for (int round = 0; round < options.rounds; ++round) {
    smoother.solve(path);
    for (std::size_t i = 0; i < path.size(); ++i) path[i] = smoother.state(i).head<3>();
  }
  std::vector<TrajectoryPoint> result(path.size());
  for (std::size_t i = 0; i < path.size(); ++i) {
    TrajectoryPoint& point = result[i];
    point.position = path[i];
    point.velocity = smoother.state(i).tail<3>();
    point.covariance = smoother.P(i).topLeftCorner<3, 3>();
    count_rays(lines.at(i), options.bound, point);
  }
  return result;
}

void append_squares(const PointLines& lines, std::span<const TrajectoryPoint> path, std::vector<double>& squares) {
  for (std::size_t i = 0; i < path.size(); ++i) {
    for (const SightLine& line : lines.at(i)) {
      if (line.depth(path[i].position) > 0.1)
        squares.push_back(line.error(path[i].position).squaredNorm() / (line.sigma * line.sigma));
    }
  }
}

}  // namespace marey::reconstruct::keypoints
