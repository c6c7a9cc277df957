#include "marey/solve/skeleton/smooth.h"

#include <algorithm>
#include <array>

#include <Eigen/Cholesky>

#include "marey/solve/skeleton/pose_solver.h"

namespace marey::solve::skeleton {
namespace {

constexpr double kHeld = 1e-3;  // 1/rad², 1/m²: what nothing determines stays where it is

/// A symmetric system of n × n blocks with two beside the diagonal, which hold diagonal matrices: L D Lᵀ, block by block.
class BandedSystem {
 public:
  BandedSystem(std::size_t blocks, int n)
      : n_(n),
        diagonal_(blocks, Eigen::MatrixXd::Zero(n, n)),
        next_(blocks, Eigen::VectorXd::Zero(n)),
        second_(next_),
        right_(next_) {}

  Eigen::MatrixXd& diagonal(std::size_t t) { return diagonal_[t]; }
  Eigen::VectorXd& right(std::size_t t) { return right_[t]; }

  /// Adds the square of Σ cᵢ x(t + i) + error, weighed, for i = 0, 1, 2 and c = 1, −2, 1.
  void add_second_difference(std::size_t t, const Eigen::VectorXd& weight, const Eigen::VectorXd& error) {
    constexpr std::array<double, 3> c = {1, -2, 1};
    for (std::size_t i = 0; i < 3; ++i) {
      diagonal_[t + i].diagonal() += c[i] * c[i] * weight;
      right_[t + i].array() -= c[i] * weight.array() * error.array();
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
      Eigen::MatrixXd to_next = t + 1 < count ? Eigen::MatrixXd(next_[t].asDiagonal()) : Eigen::MatrixXd::Zero(n_, n_);
      if (t > 0) to_next.noalias() -= first[t - 1].transpose() * second_block(t - 1);
      first[t] = factors[t].solve(to_next);
      second[t] = factors[t].solve(second_block(t));
      if (t + 1 < count) diagonal_[t + 1].noalias() -= to_next.transpose() * first[t];
      if (t + 2 < count) diagonal_[t + 2].noalias() -= second_block(t).transpose() * second[t];
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
  Eigen::MatrixXd second_block(std::size_t t) const { return Eigen::MatrixXd(second_[t].asDiagonal()); }

  int n_;
  std::vector<Eigen::MatrixXd> diagonal_;
  std::vector<Eigen::VectorXd> next_, second_, right_;
};

/// One window: states are moved to where all frames together want them.
void smooth_window(PoseSolver& solver, std::span<SkeletonState> states, std::span<const SeenMarkers> frames,
                   const Eigen::VectorXd& weight) {
  const Articulation& articulation = solver.articulation();
  const int n = articulation.dofs();
  BandedSystem system(states.size(), n);
  PoseEquations equations;
  for (std::size_t t = 0; t < states.size(); ++t) {
    solver.linearise(states[t], frames[t], equations);
    solver.add_limits(states[t], equations);
    system.diagonal(t) += equations.information;
    system.diagonal(t).diagonal().array() += kHeld;
    system.right(t) += equations.gradient;
  }
  Eigen::VectorXd before(n), after(n);
  for (std::size_t t = 0; t + 2 < states.size(); ++t) {
    articulation.difference(states[t], states[t + 1], before);
    articulation.difference(states[t + 1], states[t + 2], after);
    system.add_second_difference(t, weight, after - before);
  }
  system.solve();
  SkeletonState moved;
  for (std::size_t t = 0; t < states.size(); ++t) {
    articulation.move(states[t], system.right(t), moved);
    articulation.take_angles(moved);
    std::swap(states[t], moved);
  }
}

}  // namespace

std::vector<std::vector<double>> smooth(const Skeleton& skeleton, std::span<const std::vector<double>> rows,
                                        std::span<const SeenMarkers> frames, double rate_hz, const SmoothOptions& options) {
  PoseSolver solver(skeleton, {.marker_sigma_m = options.marker_sigma_m});
  const Articulation& articulation = solver.articulation();
  Eigen::VectorXd weight(articulation.dofs());
  for (int d = 0; d < articulation.dofs(); ++d) {
    const double step =
        (articulation.dof()[static_cast<std::size_t>(d)].turns ? options.acceleration_rad_s2 : options.acceleration_m_s2) /
        (rate_hz * rate_hz);
    weight[d] = 1 / (step * step);
  }
  std::vector<SkeletonState> states;
  for (const std::vector<double>& row : rows) states.push_back(articulation.state_of(row));
  const auto window = static_cast<std::size_t>(options.window), overlap = static_cast<std::size_t>(options.overlap);
  std::vector<std::vector<double>> smoothed;
  for (std::size_t begin = 0; begin < states.size(); begin += window) {
    const std::size_t from = begin > overlap ? begin - overlap : 0, to = std::min(states.size(), begin + window + overlap);
    std::vector<SkeletonState> part(states.begin() + static_cast<std::ptrdiff_t>(from),
                                    states.begin() + static_cast<std::ptrdiff_t>(to));
    for (int round = 0; round < options.rounds; ++round) smooth_window(solver, part, frames.subspan(from, to - from), weight);
    for (std::size_t t = begin; t < std::min(states.size(), begin + window); ++t) smoothed.push_back(part[t - from].coordinates);
  }
  return smoothed;
}

}  // namespace marey::solve::skeleton
