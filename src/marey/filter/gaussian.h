#pragma once

// What filters with a Gaussian state share: taking in a measured position, and the ellipse in which one is expected.

#include <cmath>

#include <Eigen/LU>

#include "marey/core/geometry.h"

namespace marey::filter {

/// How many standard deviations of covariance S a residual is long: Mahalanobis's distance.
template <int D>
double mahalanobis(const Vector<D>& residual, const Matrix<D>& S) {
  return std::sqrt(std::max(0.0, residual.dot(S.inverse() * residual)));
}

/// Kalman's update of the state (x, P), whose first D entries are the position, by the measured position z with covariance R.
/// The position's rows of P are formed as R S⁻¹ P and the others as P − K S Kᵀ: exact, symmetric, and no digits of the
/// position are lost where P is far larger than R, as it is after a long gap.
template <int D, int N>
void correct_position(Vector<N>& x, Matrix<N>& P, const Vector<D>& z, const Matrix<D>& R) {
  const Matrix<D> S = P.template topLeftCorner<D, D>() + R;
  const Matrix<D> S_inverse = S.inverse();
  const Eigen::Matrix<double, N, D> column = P.template leftCols<D>();
  const Eigen::Matrix<double, N, D> K = column * S_inverse;
  const Vector<D> residual = z - x.template head<D>();
  x += K * residual;
  P.noalias() -= K * column.transpose();
  const Eigen::Matrix<double, D, N> rows = R * S_inverse * column.transpose();
  P.template topRows<D>() = rows;
  P.template leftCols<D>() = rows.transpose();
  P = (0.5 * (P + P.transpose())).eval();
}

}  // namespace marey::filter
