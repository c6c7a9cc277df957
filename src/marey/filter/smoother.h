// The state at each instant given all observations, before and after it: the smoother of Rauch, Tung & Striebel.
//
// A filter has gone forwards and has left its prediction and its corrected state of each instant; whatever it was (linear,
// linearised, in any coordinates), the backward pass is this. Reference: Rauch, Tung & Striebel, "Maximum likelihood estimates of
// linear dynamic systems", AIAA Journal 3 (1965). Cost: a factorisation and five products of N × N an instant. Where positions are
// observed and the motion is linear, position_smoother.h does the same with less work.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Cholesky>

#include "marey/core/geometry.h"

namespace marey::filter {

/// A state of N numbers; D of them that share their covariance (the axes of a point), else one.
template <int N, int D = 1>
struct Estimate {
  Eigen::Matrix<double, N, D> mean = Eigen::Matrix<double, N, D>::Zero();
  Matrix<N> covariance = Matrix<N>::Zero();
};

/// What `known` becomes by what came later: the next instant was `expected` = F · `known` + noise, and is `smoothed` given all.
/// `expected` has a covariance that can be inverted.
template <int N, int D>
Estimate<N, D> smoothed_back(const Estimate<N, D>& known, const Matrix<N>& F, const Estimate<N, D>& expected,
                             const Estimate<N, D>& smoothed) {
  const Matrix<N> gain = expected.covariance.ldlt().solve(F * known.covariance).transpose();
  const Matrix<N> covariance = known.covariance + gain * (smoothed.covariance - expected.covariance) * gain.transpose();
  return {known.mean + gain * (smoothed.mean - expected.mean), 0.5 * (covariance + covariance.transpose())};
}

/// A forward pass kept, and its backward pass.
template <int N, int D = 1>
class Smoother {
 public:
  void reserve(std::size_t instants) { instants_.reserve(instants); }

  /// The next instant: F leads to it from the one before (of no meaning at the first).
  void add(const Matrix<N>& F, const Estimate<N, D>& expected, const Estimate<N, D>& known) {
    instants_.push_back({F, expected, known});
  }

  /// The states at all instants so far, each given all; they are forgotten.
  std::vector<Estimate<N, D>> smoothed() {
    std::vector<Estimate<N, D>> all(instants_.size());
    for (std::size_t i = instants_.size(); i-- > 0;) {
      all[i] = instants_[i].known;
      if (i + 1 < instants_.size()) all[i] = smoothed_back(all[i], instants_[i + 1].F, instants_[i + 1].expected, all[i + 1]);
    }
    instants_.clear();
    return all;
  }

 private:
  struct Instant {
    Matrix<N> F;
    Estimate<N, D> expected, known;
  };
  std::vector<Instant> instants_;
};

}  // namespace marey::filter
