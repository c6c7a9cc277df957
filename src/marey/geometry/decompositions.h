#pragma once

#include "marey/geometry/vector.h"

// Eigen's decompositions, compiled once: each costs the compiler 1 to 7 s wherever its template is used.

namespace marey::geometry {

/// A = U diag(values) Vᵀ with U and V orthogonal and the values falling, none negative.
struct SingularValues3 {
  Matrix<3> U;
  Vector<3> values;
  Matrix<3> V;
};
SingularValues3 singular_values(const Matrix<3>& A);

/// Eigenvalues of a symmetric matrix, rising, and their unit vectors as columns.
template <int N>
struct Eigenpairs {
  Vector<N> values;
  Matrix<N> vectors;
};

/// Of a symmetric matrix, whose lower half is read. N = 3, 9 or Eigen::Dynamic.
template <int N>
Eigenpairs<N> eigenpairs(const Matrix<N>& symmetric);

extern template Eigenpairs<3> eigenpairs(const Matrix<3>& symmetric);
extern template Eigenpairs<9> eigenpairs(const Matrix<9>& symmetric);
extern template Eigenpairs<Eigen::Dynamic> eigenpairs(const Eigen::MatrixXd& symmetric);

/// The X with A X = B, where A is symmetric and not indefinite; its lower half is read.
Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

/// The x for which A x is nearest to b.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

}  // namespace marey::geometry
