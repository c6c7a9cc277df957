// Where something was, from observed places before and after each instant: the one smoother of paths, of any motion model, in an
// image, on the ground, in space.
//
// B coordinates whose errors go together (a place on the ground with its 2 × 2 covariance), and C of these that are observed alike
// (the axes of a point with one variance). The state is the place and its derivatives; each coordinate moves as the motion says, so
// the covariance is kept by B × B blocks and the transition is a number for each block. The backward pass has the form of Bryson
// & Frazier: an adjoint of the state's size instead of a covariance to invert. References: Rauch, Tung & Striebel, "Maximum
// likelihood estimates of linear dynamic systems", AIAA Journal 3 (1965); Bierman, "Fixed interval smoothing with discrete
// measurements", Int. J. Control 18 (1973). Cost: about 15 products of B × B an instant with three derivatives; covariances a few
// of the whole state's size. Filters whose measurements are not places go back by smoother.h.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/LU>

#include "marey/core/geometry.h"
#include "marey/filter/bridge.h"

namespace marey::filter {

/// The place and its derivatives up to `Order` − 1, with their covariance.
template <int Order, int B, int C = 1>
struct MovingState {
  using Value = Eigen::Matrix<double, B, C>;

  static constexpr int upper(int i, int j) { return i * (2 * Order - i - 1) / 2 + j; }  // i ≤ j

  std::array<Value, Order> x = filled<Value, Order>();
  /// Place and place, place and velocity, …; velocity and velocity, …: the upper triangle by rows.
  std::array<Matrix<B>, Order*(Order + 1) / 2> P = filled<Matrix<B>, Order*(Order + 1) / 2>();

  Matrix<Order * B> covariance() const {
    Matrix<Order * B> whole;
    for (int i = 0; i < Order; ++i) {
      for (int j = i; j < Order; ++j) {
        whole.template block<B, B>(B * i, B * j) = P[upper(i, j)];
        whole.template block<B, B>(B * j, B * i) = P[upper(i, j)].transpose();
      }
    }
    return whole;
  }

 private:
  template <typename T, std::size_t count>
  static std::array<T, count> filled() {
    std::array<T, count> zeros;
    zeros.fill(T::Zero());
    return zeros;
  }
};

/// The state after a step, whose F is upper triangular; `noise`: the power of its noise in units of what the motion says.
template <int Order, int B, int C>
void advance(MovingState<Order, B, C>& state, const Transition<Order>& step, double noise = 1) {
  using State = MovingState<Order, B, C>;
  const Matrix<Order>& F = step.F;
  // Rows of F P, then times Fᵀ: sums over what lies on or right of the diagonal.
  std::array<std::array<Matrix<B>, Order>, Order> FP;
  for (int i = 0; i < Order; ++i) {
    for (int j = 0; j < Order; ++j) {
      FP[i][j].setZero();
      for (int k = i; k < Order; ++k) {
        if (k <= j) {
          FP[i][j] += F(i, k) * state.P[State::upper(k, j)];
        } else {
          FP[i][j] += F(i, k) * state.P[State::upper(j, k)].transpose();
        }
      }
    }
  }
  for (int i = 0; i < Order; ++i) {
    for (int j = i; j < Order; ++j) {
      Matrix<B>& block = state.P[State::upper(i, j)];
      block = F(j, j) * FP[i][j];
      for (int k = j + 1; k < Order; ++k) block += F(j, k) * FP[i][k];
      block.diagonal().array() += noise * step.Q(i, j);
    }
  }
  for (int i = 0; i < Order; ++i) {
    typename State::Value further = State::Value::Zero();
    for (int j = i + 1; j < Order; ++j) further += F(i, j) * state.x[j];
    state.x[i] = (F(i, i) * state.x[i] + further).eval();
  }
}

/// The state with an observed place.
template <int Order, int B, int C>
void correct(MovingState<Order, B, C>& state, const Eigen::Matrix<double, B, C>& z, const Matrix<B>& R) {
  using State = MovingState<Order, B, C>;
  const Matrix<B> S_inverse = (state.P[0] + R).inverse();
  const typename State::Value residual = z - state.x[0];
  std::array<Matrix<B>, Order> K;
  K[0] = state.P[0] * S_inverse;
  for (int i = 1; i < Order; ++i) K[i] = state.P[i].transpose() * S_inverse;
  for (int i = 0; i < Order; ++i) state.x[i] += K[i] * residual;
  // P − K S Kᵀ; the blocks of the place as R S⁻¹ P, which loses no digits where P is far larger than R.
  for (int i = 1; i < Order; ++i) {
    for (int j = i; j < Order; ++j) state.P[State::upper(i, j)] -= K[i] * state.P[j];
  }
  const Matrix<B> left = R * S_inverse;
  for (int j = 0; j < Order; ++j) state.P[j] = (left * state.P[j]).eval();
  for (int i = 0; i < Order; ++i) {
    Matrix<B>& block = state.P[State::upper(i, i)];
    block = (0.5 * (block + block.transpose())).eval();
  }
}

/// A path: instants in order, then the state of each, given all of them.
template <typename Motion, int B, int C = 1>
class PositionSmoother {
 public:
  static constexpr int N = Motion::order;
  using State = MovingState<N, B, C>;
  using Value = typename State::Value;
  using Values = std::array<Value, N>;

  /// `first`: the prior of the first instant, before its observation.
  PositionSmoother(const Motion& motion, const State& first) : motion_(motion), state_(first) {}

  void reserve(std::size_t instants) { instants_.reserve(instants); }

  /// The next instant, `dt` s after the one before (of no meaning at the first), and the place that was observed.
  void add(double dt, double noise, const Value& z, const Matrix<B>& R) {
    step(dt, noise);
    instants_.push_back({state_, z, R, true, static_cast<int>(steps_.size()) - 1});
    correct(state_, z, R);
  }
  /// The same without an observation.
  void add_unobserved(double dt, double noise = 1) {
    step(dt, noise);
    instants_.push_back({state_, Value::Zero(), Matrix<B>::Identity(), false, static_cast<int>(steps_.size()) - 1});
  }

  /// Of the last instant, by all until then.
  const State& state() const { return state_; }

  /// Place and derivatives of each instant.
  std::vector<Values> smoothed() const {
    std::vector<Values> all(instants_.size());
    Values l;  // the adjoint
    l.fill(Value::Zero());
    for (std::size_t i = instants_.size(); i-- > 0;) {
      const Instant& one = instants_[i];
      const auto& P = one.before.P;
      if (one.observed) {
        Value off = one.z - one.before.x[0];
        for (int j = 0; j < N; ++j) off += P[j] * l[j];
        l[0] -= (P[0] + one.R).inverse() * off;
      }
      for (int row = 0; row < N; ++row) {
        all[i][row] = one.before.x[row];
        for (int j = 0; j < row; ++j) all[i][row] -= P[State::upper(j, row)].transpose() * l[j];
        for (int j = row; j < N; ++j) all[i][row] -= P[State::upper(row, j)] * l[j];
      }
      if (i == 0) break;
      const Matrix<N>& F = steps_[static_cast<std::size_t>(one.step)].F;
      for (int row = N; row-- > 0;) {
        Value sum = F(0, row) * l[0];
        for (int k = 1; k <= row; ++k) sum += F(k, row) * l[k];
        l[row] = sum;
      }
    }
    return all;
  }

  /// The covariance of the place at each instant: that of the state before its observation, less the information of this one
  /// and all later ones (the adjoint's information, Bierman 1973).
  std::vector<Matrix<B>> position_covariances() const {
    std::vector<Matrix<B>> all(instants_.size());
    Matrix<N * B> reported = Matrix<N * B>::Zero();
    for (std::size_t i = instants_.size(); i-- > 0;) {
      const Instant& one = instants_[i];
      const Matrix<N * B> P = one.before.covariance();
      if (one.observed) {
        const Matrix<B> S_inverse = (P.template topLeftCorner<B, B>() + one.R).inverse();
        Matrix<N * B> left = Matrix<N * B>::Identity();
        left.template leftCols<B>() -= P.template leftCols<B>() * S_inverse;
        reported = (left.transpose() * reported * left).eval();
        reported.template topLeftCorner<B, B>() += S_inverse;
      }
      all[i] = P.template topLeftCorner<B, B>() - P.template topRows<B>() * reported * P.template leftCols<B>();
      if (i == 0) break;
      const Matrix<N>& F = steps_[static_cast<std::size_t>(one.step)].F;
      Matrix<N * B> forward = Matrix<N * B>::Zero();
      for (int row = 0; row < N; ++row) {
        for (int column = row; column < N; ++column)
          forward.template block<B, B>(B * row, B * column).diagonal().setConstant(F(row, column));
      }
      reported = (forward.transpose() * reported * forward).eval();
    }
    return all;
  }

 private:
  struct Instant {
    State before;
    Value z;
    Matrix<B> R;
    bool observed = false;
    int step = 0;  // that led to it
  };

  void step(double dt, double noise) {
    if (instants_.empty()) return;
    if (!last_ || std::abs(dt - *last_) > 1e-7) {
      last_ = dt;
      steps_.push_back(motion_.over(dt));
    }
    advance(state_, steps_.back(), noise);
  }

  Motion motion_;
  State state_;
  std::vector<Instant> instants_;
  std::vector<Transition<N>> steps_;  // most are as long as the one before, and stand once
  std::optional<double> last_;
};

/// Places, and their derivatives by rows, from observed ones with a column for each coordinate. `variances` are those of one
/// coordinate of `places`, infinite where nothing was observed; the first is finite. `unknown`: variance of each derivative of the
/// place before anything is known.
template <typename Motion, int C>
std::vector<Eigen::Matrix<double, Motion::order, C>> smoothed_positions(const Motion& motion, std::span<const double> times_s,
                                                                        std::span<const Eigen::Matrix<double, 1, C>> locations,
                                                                        std::span<const double> variances, double unknown) {
  using Smoother = PositionSmoother<Motion, 1, C>;
  typename Smoother::State first;  // with its place, of which nothing else was known
  first.x[0] = locations.front();
  for (int i = 0; i < Motion::order; ++i) first.P[Smoother::State::upper(i, i)].setConstant(i == 0 ? variances.front() : unknown);
  Smoother smoother(motion, first);
  smoother.reserve(times_s.size());
  smoother.add_unobserved(0);
  for (std::size_t i = 1; i < times_s.size(); ++i) {
    const double dt = times_s[i] - times_s[i - 1];
    if (std::isfinite(variances[i])) {
      smoother.add(dt, 1, locations[i], Matrix<1>(variances[i]));
    } else {
      smoother.add_unobserved(dt);
    }
  }
  std::vector<Eigen::Matrix<double, Motion::order, C>> states(times_s.size());
  const auto smoothed = smoother.smoothed();
  for (std::size_t i = 0; i < states.size(); ++i) {
    for (int row = 0; row < Motion::order; ++row) states[i].row(row) = smoothed[i][row];
  }
  return states;
}

}  // namespace marey::filter
