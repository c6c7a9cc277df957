// Vectors and covariances by chance, for tests.
#pragma once

#include <random>

#include "marey/core/geometry.h"

namespace marey::filter {

template <int D>
class RandomMeasurements {
 public:
  Vector<D> random_vector(double sigma) {
    std::normal_distribution<double> normal(0, sigma);
    Vector<D> v;
    for (int i = 0; i < D; ++i) v[i] = normal(random_);
    return v;
  }

  /// Symmetric and positive, with axes of different length.
  Matrix<D> random_covariance(double sigma) {
    Matrix<D> A;
    for (int i = 0; i < D; ++i) A.col(i) = random_vector(sigma);
    return A * A.transpose() + 0.01 * sigma * sigma * Matrix<D>::Identity();
  }

 protected:
  std::mt19937 random_{20};  // NOLINT: a seed, so that a failure comes back
};

}  // namespace marey::filter
