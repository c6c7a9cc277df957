#include "marey/geometry/local_polynomial.h"

#include <cmath>
#include <random>
#include <vector>

#include <Eigen/QR>
#include <gtest/gtest.h>

namespace marey::geometry {
namespace {

/// The slow twin: least squares over a matrix with a row for each value, by QR.
template <int N, int C>
Eigen::Matrix<double, N, C> by_rows(const std::vector<double>& times, const std::vector<double>& weights,
                                    const Eigen::Matrix<double, Eigen::Dynamic, C>& values) {
  Eigen::Matrix<double, Eigen::Dynamic, N> basis(times.size(), N);
  Eigen::Matrix<double, Eigen::Dynamic, C> right = values;
  for (Eigen::Index i = 0; i < basis.rows(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    for (int n = 0; n < N; ++n) basis(i, n) = std::sqrt(weights[k]) * std::pow(times[k], n);
    right.row(i) *= std::sqrt(weights[k]);
  }
  return basis.colPivHouseholderQr().solve(right);
}

template <int N>
void compare_with_twin() {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<double> times, weights;
    Eigen::Matrix<double, Eigen::Dynamic, 2> values(10, 2);
    LocalPolynomial<N, 2> fitted;
    for (Eigen::Index i = 0; i < values.rows(); ++i) {
      times.push_back(uniform(random));
      weights.push_back(1.1 + uniform(random));
      values.row(i) << uniform(random), uniform(random);
      fitted.add(times.back(), weights.back(), values.row(i));
    }
    const auto expected = by_rows<N, 2>(times, weights, values);
    EXPECT_LT((fitted.fit() - expected).norm(), 1e-9 * (1 + expected.norm()));
    const auto determined = fitted.well_determined_fit(1e-12);
    ASSERT_TRUE(determined);
    EXPECT_LT((*determined - expected).norm(), 1e-8 * (1 + expected.norm()));
  }
}

TEST(LocalPolynomial, AgreesWithRows) {
  compare_with_twin<2>();
  compare_with_twin<3>();
}

TEST(LocalPolynomial, TooFewTimesGiveTheShortest) {
  LocalPolynomial<3, 1> parabola;
  parabola.add(0, 1, Matrix<1>(5.0));
  EXPECT_NEAR(parabola.fit()(0), 5, 1e-12);
  EXPECT_NEAR(parabola.fit()(1), 0, 1e-12);
  EXPECT_FALSE(parabola.well_determined_fit(1e-9));
  LocalPolynomial<2, 1> line;
  line.add(0.5, 1, Matrix<1>(3.0));
  line.add(0.5, 3, Matrix<1>(7.0));
  EXPECT_NEAR(line.fit()(0), 6, 1e-12);
  EXPECT_EQ(line.fit()(1), 0);
  EXPECT_NEAR(line.mean()(0), 6, 1e-12);
  EXPECT_EQ(line.weight(), 4);
}

}  // namespace
}  // namespace marey::geometry
