// A polynomial through weighted values about t = 0, by least squares: local regression, which smooths a path without lag where it
// is asked at each of its times with weights that fall off to both sides. Cost: N² sums a value, one solution of N unknowns.
// References: Savitzky & Golay, Analytical Chemistry 36 (1964), of even times and weights; Cleveland & Devlin, "Locally weighted
// regression", JASA 83 (1988).
#pragma once

#include <limits>
#include <optional>

#include <Eigen/Cholesky>

#include "marey/geometry/decompositions.h"
#include "marey/geometry/vector.h"

namespace marey::geometry {

/// `N` coefficients, of 1, t, t², …, and `C` coordinates that are observed with the same weights.
template <int N, int C>
class LocalPolynomial {
 public:
  using Value = Eigen::Matrix<double, 1, C>;
  using Coefficients = Eigen::Matrix<double, N, C>;  ///< by rows

  void add(double t, double weight, const Value& value) {
    Vector<N> basis;
    basis[0] = 1;
    for (int i = 1; i < N; ++i) basis[i] = basis[i - 1] * t;
    add(basis, weight, value);
  }
  /// With other functions of time in place of the powers.
  void add(const Vector<N>& basis, double weight, const Value& value) {
    const Vector<N> weighted = weight * basis;
    normal_ += weighted * basis.transpose();
    right_ += weighted * value;
  }

  double weight() const { return normal_(0, 0); }
  /// weight() > 0.
  Value mean() const { return right_.row(0) / weight(); }

  /// The shortest where several fit as well, as with fewer times than coefficients. weight() > 0.
  Coefficients fit() const {
    if constexpr (N == 2) {
      const double spread = normal_(1, 1) - normal_(0, 1) * normal_(0, 1) / normal_(0, 0);
      Coefficients line = Coefficients::Zero();
      if (spread > kMinSpread) line.row(1) = (right_.row(1) - normal_(0, 1) * right_.row(0) / normal_(0, 0)) / spread;
      line.row(0) = right_.row(0) / normal_(0, 0) - line.row(1) * normal_(0, 1) / normal_(0, 0);
      return line;
    } else {
      const auto [values, vectors] = eigenpairs<N>(normal_);
      const double minimum = N * std::numeric_limits<double>::epsilon() * values[N - 1];
      Coefficients x = Coefficients::Zero();
      for (int i = 0; i < N; ++i) {
        if (values[i] > minimum) x += vectors.col(i) * (vectors.col(i).transpose() * right_ / values[i]);
      }
      return x;
    }
  }

  /// Nothing if the reciprocal condition of the normal equations is below `min_condition`.
  std::optional<Coefficients> well_determined_fit(double min_condition) const {
    const Eigen::LLT<Matrix<N>> solver(normal_);
    if (solver.info() != Eigen::Success || solver.rcond() < min_condition) return std::nullopt;
    return solver.solve(right_);
  }

 private:
  static constexpr double kMinSpread = 1e-12;  // numerical: of times squared, of which a slope is divided by

  Matrix<N> normal_ = Matrix<N>::Zero();
  Coefficients right_ = Coefficients::Zero();
};

}  // namespace marey::geometry
