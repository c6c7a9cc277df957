#include "marey/geometry/decompositions.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace marey::geometry {

SingularValues3 singular_values(const Matrix<3>& A) {
  const Eigen::JacobiSVD<Matrix<3>> svd(A, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return {svd.matrixU(), svd.singularValues(), svd.matrixV()};
}

template <int N>
Eigenpairs<N> eigenpairs(const Matrix<N>& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Matrix<N>> solver(symmetric);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

template Eigenpairs<3> eigenpairs(const Matrix<3>& symmetric);
template Eigenpairs<9> eigenpairs(const Matrix<9>& symmetric);
template Eigenpairs<Eigen::Dynamic> eigenpairs(const Eigen::MatrixXd& symmetric);

Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  return A.ldlt().solve(B);
}

Eigen::VectorXd least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  return A.colPivHouseholderQr().solve(b);
}

}  // namespace marey::geometry
