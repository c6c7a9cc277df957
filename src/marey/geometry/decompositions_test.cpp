#include "marey/geometry/decompositions.h"

#include <random>

#include <gtest/gtest.h>

namespace marey::geometry {
namespace {

template <int N>
Matrix<N> random_matrix(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Matrix<N> A;
  for (int i = 0; i < N * N; ++i) A(i / N, i % N) = normal(random);
  return A;
}

TEST(Decompositions, SingularValuesGiveTheMatrixBack) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Matrix<3> A = random_matrix<3>(seed);
    const SingularValues3 svd = singular_values(A);
    EXPECT_LT((svd.U * svd.values.asDiagonal() * svd.V.transpose() - A).norm(), 1e-12);
    EXPECT_LT((svd.U * svd.U.transpose() - Matrix<3>::Identity()).norm(), 1e-12);
    EXPECT_LT((svd.V * svd.V.transpose() - Matrix<3>::Identity()).norm(), 1e-12);
    EXPECT_TRUE(svd.values(0) >= svd.values(1) && svd.values(1) >= svd.values(2) && svd.values(2) >= 0);
  }
}

template <int N>
void check_eigenpairs(unsigned seed) {
  const Matrix<N> half = random_matrix<N>(seed);
  const Matrix<N> A = half + half.transpose();
  const Eigenpairs<N> eigen = eigenpairs<N>(A);
  EXPECT_LT((A * eigen.vectors - eigen.vectors * eigen.values.asDiagonal()).norm(), 1e-11);
  for (int i = 1; i < N; ++i) EXPECT_LE(eigen.values(i - 1), eigen.values(i));
}

TEST(Decompositions, EigenpairsAreThose) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    check_eigenpairs<3>(seed);
    check_eigenpairs<9>(seed);
  }
}

}  // namespace
}  // namespace marey::geometry
