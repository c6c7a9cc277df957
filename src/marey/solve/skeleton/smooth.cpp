#include "marey/solve/skeleton/smooth.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>

#include "marey/solve/skeleton/gaps.h"
#include "marey/solve/skeleton/pose_solver.h"

namespace marey::solve::skeleton {
namespace {

constexpr double kOtherM = 0.1;  // a marker so far off is another
constexpr double kHeld = 1e-3;   // 1/rad², 1/m²; numerical: what nothing determines stays where it is

/// A symmetric system of n × n blocks with two beside the diagonal: L D Lᵀ, block by block.
class BandedSystem {
 public:
  BandedSystem(std::size_t blocks, int n)
      : n_(n),
        diagonal_(blocks, Eigen::MatrixXd::Zero(n, n)),
        next_(diagonal_),
        second_(diagonal_),
        right_(blocks, Eigen::VectorXd::Zero(n)) {}

  Eigen::MatrixXd& diagonal(std::size_t t) { return diagonal_[t]; }
  Eigen::VectorXd& right(std::size_t t) { return right_[t]; }

  /// Adds the square of Σ cᵢ x(t + i) + error, weighed, for i = 0, 1, 2 and c = 1, −2, 1.
  void add_second_difference(std::size_t t, const Eigen::MatrixXd& weight, const Eigen::VectorXd& error) {
    constexpr std::array<double, 3> c = {1, -2, 1};
    const Eigen::VectorXd pull = weight * error;
    for (std::size_t i = 0; i < 3; ++i) {
      diagonal_[t + i] += c[i] * c[i] * weight;
      right_[t + i] -= c[i] * pull;
    }
    next_[t] += c[0] * c[1] * weight;
    next_[t + 1] += c[1] * c[2] * weight;
    second_[t] += c[0] * c[2] * weight;
  }

  /// The solution takes the right-hand side's place. Afterwards the system is used up.
  void solve() {
    const std::size_t count = diagonal_.size();
    std::vector<Eigen::MatrixXd> first(count), second(count);  // L of the next block and of the one after, transposed: D⁻¹ A
    std::vector<Eigen::LDLT<Eigen::MatrixXd>> factors(count);
    for (std::size_t t = 0; t < count; ++t) {
      factors[t].compute(diagonal_[t]);
      Eigen::MatrixXd to_next = t + 1 < count ? next_[t] : Eigen::MatrixXd::Zero(n_, n_);
      if (t > 0) to_next.noalias() -= first[t - 1].transpose() * second_[t - 1];
      first[t] = factors[t].solve(to_next);
      second[t] = factors[t].solve(second_[t]);
      if (t + 1 < count) diagonal_[t + 1].noalias() -= to_next.transpose() * first[t];
      if (t + 2 < count) diagonal_[t + 2].noalias() -= second_[t].transpose() * second[t];
      if (t + 1 < count) right_[t + 1].noalias() -= first[t].transpose() * right_[t];
      if (t + 2 < count) right_[t + 2].noalias() -= second[t].transpose() * right_[t];
    }
    for (std::size_t t = count; t-- > 0;) {
      right_[t] = factors[t].solve(right_[t]);
      if (t + 1 < count) right_[t].noalias() -= first[t] * right_[t + 1];
      if (t + 2 < count) right_[t].noalias() -= second[t] * right_[t + 2];
    }
  }

 private:
  int n_;
  std::vector<Eigen::MatrixXd> diagonal_, next_, second_;
  std::vector<Eigen::VectorXd> right_;
};

class Smoother {
 public:
  Smoother(const Skeleton& skeleton, std::span<const std::vector<double>> rows, std::span<const ObservedMarkers> frames,
           double rate_hz, const SmoothOptions& options)
      : skeleton_(skeleton),
        solver_(skeleton),
        frames_(frames),
        options_(options),
        hidden_(static_cast<std::size_t>(std::max(1.0, options.hidden_s * rate_hz))),
        whole_(whole_frames(skeleton, frames, hidden_)),
        weight_(solver_.articulation().dofs()) {
    for (int d = 0; d < solver_.articulation().dofs(); ++d) {
      const bool is_rotation = solver_.articulation().dof()[static_cast<std::size_t>(d)].is_rotation;
      weight_[d] = rate_hz * rate_hz / (is_rotation ? options.acceleration_rad_s2 : options.acceleration_m_s2);
    }
    for (const std::vector<double>& row : rows) states_.push_back(solver_.articulation().state_of(row));
    solver_.learn_noise_of(rows, frames);
    find_offsets();
    guide();
  }

  std::vector<std::vector<double>> run() {
    const auto window = static_cast<std::size_t>(options_.window), overlap = static_cast<std::size_t>(options_.overlap);
    std::vector<std::vector<double>> smoothed;
    for (std::size_t begin = 0; begin < states_.size(); begin += window) {
      const std::size_t from = begin > overlap ? begin - overlap : 0, to = std::min(states_.size(), begin + window + overlap);
      std::vector<SkeletonState> part(states_.begin() + static_cast<std::ptrdiff_t>(from),
                                      states_.begin() + static_cast<std::ptrdiff_t>(to));
      for (int round = 0; round < options_.rounds; ++round) smooth_window(part, from);
      for (std::size_t t = begin; t < std::min(states_.size(), begin + window); ++t) smoothed.push_back(part[t - from].coordinates);
    }
    return smoothed;
  }

 private:
  /// Of each marker in each frame: where it is found on its segment, from where the skeleton has it.
  void find_offsets() {
    offsets_.assign(frames_.size(), std::vector<Vector<3>>(skeleton_.markers.size(), Vector<3>::Zero()));
    for (std::size_t f = 0; f < frames_.size(); ++f) {
      solver_.articulation().location(states_[f]);
      for (std::size_t j = 0; j < skeleton_.markers.size(); ++j) {
        if (!frames_[f][j]) continue;
        const Rigid3& world_from =
            solver_.articulation().world_from_segment()[static_cast<std::size_t>(skeleton_.markers[j].segment)];
        const Vector<3> offset = world_from.inverse() * *frames_[f][j] - skeleton_.markers[j].position;
        if (offset.norm() < kOtherM) offsets_[f][j] = offset;
      }
    }
  }

  const WholeFrames& whole(std::size_t segment, std::size_t frame) const { return whole_[segment][frame]; }

  /// Markers sit where both ends of a gap have them. Without a gap: where the skeleton has them.
  void adapt(std::size_t f) {
    for (std::size_t j = 0; j < skeleton_.markers.size(); ++j) {
      const WholeFrames& ends = whole(static_cast<std::size_t>(skeleton_.markers[j].segment), f);
      const Fractions fractions = fractions_of(ends, f, hidden_);
      Vector<3>& shift = solver_.shifts()[j];
      shift.setZero();
      if (fractions.before > 0) shift += fractions.before * offsets_[*ends.before][j];
      if (fractions.after > 0) shift += fractions.after * offsets_[*ends.after][j];
    }
  }

  /// In a gap, every joint interpolated from its pose before to that after; from there the frame's markers have their say.
  void guide() {
    const Articulation& articulation = solver_.articulation();
    const std::vector<SkeletonState> found = states_;
    Eigen::VectorXd step(articulation.dofs());
    for (std::size_t f = 0; f < states_.size(); ++f) {
      bool any = false;
      SkeletonState start = found[f];
      for (std::size_t s = 0; s < skeleton_.segments.size(); ++s) {
        const WholeFrames& ends = whole(s, f);
        if (ends.before == f || !skeleton_.segments[s].parent || !(ends.before && ends.after)) continue;
        any = true;
        const double fraction = static_cast<double>(f - *ends.before) / static_cast<double>(*ends.after - *ends.before);
        articulation.difference(found[*ends.before], found[*ends.after], step);
        SkeletonState between;
        articulation.move(found[*ends.before], fraction * step, between);
        take_joint(s, between, start);
      }
      if (!any) continue;
      adapt(f);
      skeleton_.couple(start.coordinates);
      states_[f] = solver_.solve_near(start, frames_[f]);
    }
  }

  void take_joint(std::size_t segment, const SkeletonState& from, SkeletonState& to) {
    for (const JointAxis& axis : skeleton_.segments[segment].joint.axes) {
      if (axis.coordinate)
        to.coordinates[static_cast<std::size_t>(*axis.coordinate)] = from.coordinates[static_cast<std::size_t>(*axis.coordinate)];
    }
    for (std::size_t b = 0; b < to.balls.size(); ++b) {
      if (solver_.articulation().balls()[b].segment == static_cast<int>(segment)) to.balls[b] = from.balls[b];
    }
  }

  /// One window from frame `first` on: states are moved to where all frames together want them.
  void smooth_window(std::span<SkeletonState> states, std::size_t first) {
    const Articulation& articulation = solver_.articulation();
    const int n = articulation.dofs();
    BandedSystem system(states.size(), n);
    PoseEquations equations;
    std::vector<Eigen::MatrixXd> open;
    for (std::size_t t = 0; t < states.size(); ++t) {
      adapt(first + t);
      open.push_back(solver_.openness(states[t], frames_[first + t]));
      solver_.linearise(states[t], frames_[first + t], equations);
      solver_.add_limits(states[t], equations);
      system.diagonal(t) += equations.information;
      system.diagonal(t).diagonal().array() += kHeld;
      system.right(t) += equations.gradient;
    }
    Eigen::VectorXd before(n), after(n);
    for (std::size_t t = 0; t + 2 < states.size(); ++t) {
      articulation.difference(states[t], states[t + 1], before);
      articulation.difference(states[t + 1], states[t + 2], after);
      const Eigen::MatrixXd mean = (open[t] + open[t + 1] + open[t + 2]) / 3;
      system.add_second_difference(t, weight_.asDiagonal() * mean * weight_.asDiagonal(), after - before);
    }
    system.solve();
    SkeletonState moved;
    for (std::size_t t = 0; t < states.size(); ++t) {
      articulation.move(states[t], system.right(t), moved);
      articulation.take_angles(moved);
      std::swap(states[t], moved);
    }
  }

  const Skeleton& skeleton_;
  PoseSolver solver_;
  std::span<const ObservedMarkers> frames_;
  SmoothOptions options_;
  std::size_t hidden_;
  std::vector<std::vector<WholeFrames>> whole_;
  Eigen::VectorXd weight_;
  std::vector<SkeletonState> states_;
  std::vector<std::vector<Vector<3>>> offsets_;
};

}  // namespace

std::vector<std::vector<double>> smooth(const Skeleton& skeleton, std::span<const std::vector<double>> rows,
                                        std::span<const ObservedMarkers> frames, double rate_hz, const SmoothOptions& options) {
  return Smoother(skeleton, rows, frames, rate_hz, options).run();
}

}  // namespace marey::solve::skeleton
