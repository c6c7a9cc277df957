#include "marey/filter/kinematics.h"

#include <random>

#include <gtest/gtest.h>

namespace marey::filter {
namespace {

using kinematics::Model;
using kinematics::State;

template <int D, int Order>
Matrix<D * Order> dense(const State<D, Order>& state) {
  Matrix<D * Order> P;
  for (int i = 0; i < Order; ++i) {
    for (int j = 0; j < Order; ++j)
      P.template block<D, D>(i * D, j * D) = state.covariance(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
  }
  return P;
}

template <int D, int Order>
Vector<D * Order> dense_mean(const State<D, Order>& state) {
  Vector<D * Order> x;
  for (int i = 0; i < Order; ++i) x.template segment<D>(i * D) = state.mean[static_cast<std::size_t>(i)];
  return x;
}

/// F ⊗ I written out.
template <int D, int Order>
Matrix<D * Order> kronecker(const Matrix<Order>& F) {
  Matrix<D * Order> full = Matrix<D * Order>::Zero();
  for (int i = 0; i < Order; ++i) {
    for (int j = 0; j < Order; ++j) full.template block<D, D>(i * D, j * D).diagonal().setConstant(F(i, j));
  }
  return full;
}

/// The slow twin is the textbook with full matrices.
template <int D, int Order>
void agrees_with_full_matrices() {
  constexpr int N = D * Order;
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::array<double, Order - 1> sigmas;
  sigmas.fill(20);
  State<D, Order> state = kinematics::at_rest<D, Order>(Vector<D>::Constant(5), 2 * Matrix<D>::Identity(), sigmas);
  Vector<N> x = dense_mean(state);
  Matrix<N> P = dense(state);
  Eigen::Matrix<double, D, N> H = Eigen::Matrix<double, D, N>::Zero();
  H.template leftCols<D>().setIdentity();
  for (int step = 0; step < 100; ++step) {
    Model<Order> model;
    for (double& entry : model.F.template rightCols<Order - 1>().reshaped()) entry += 0.1 * normal(random);
    const Vector<Order> q = Vector<Order>::NullaryExpr([&] { return normal(random); });
    model.Q = q * q.transpose() + 0.1 * Matrix<Order>::Identity();
    kinematics::predict(state, model);
    const Matrix<N> F = kronecker<D, Order>(model.F);
    x = (F * x).eval();
    P = (F * P * F.transpose() + kronecker<D, Order>(model.Q)).eval();

    const Matrix<D> A = Matrix<D>::NullaryExpr([&] { return normal(random); });
    const Matrix<D> R = A * A.transpose() + 0.1 * Matrix<D>::Identity();
    const Vector<D> z = Vector<D>::NullaryExpr([&] { return 10 * normal(random); });
    const kinematics::Innovation innovation = kinematics::correct(state, z, R);
    const Matrix<D> S = H * P * H.transpose() + R;
    const Vector<D> residual = z - H * x;
    const Eigen::Matrix<double, N, D> K = P * H.transpose() * S.inverse();
    x += K * residual;
    P = ((Matrix<N>::Identity() - K * H) * P).eval();

    const double squared = residual.dot(S.inverse() * residual);
    EXPECT_NEAR(innovation.squared, squared, 1e-9 * (1 + squared));
    EXPECT_NEAR(innovation.determinant, S.determinant(), 1e-9 * S.determinant());
    EXPECT_LE((dense_mean(state) - x).norm(), 1e-9 * (1 + x.norm())) << "step " << step;
    EXPECT_LE((dense(state) - P).norm(), 1e-9 * (1 + P.norm())) << "step " << step;
  }
}

TEST(Kinematics, BlocksAreTheFullMatrices) {
  agrees_with_full_matrices<2, 2>();
  agrees_with_full_matrices<2, 3>();
  agrees_with_full_matrices<3, 2>();
  agrees_with_full_matrices<3, 3>();
}

/// F and Q by adding up n short steps of ẋ = A x + noise, each exact to second order.
Model<3> by_small_steps(const Matrix<3>& A, double density, double dt, int n) {
  const double h = dt / n;
  const Matrix<3> step = Matrix<3>::Identity() + h * A + 0.5 * h * h * A * A + h * h * h / 6 * A * A * A;
  const Matrix<3> half = Matrix<3>::Identity() + 0.5 * h * A + 0.125 * h * h * A * A;
  const Vector<3> kick = half * Vector<3>(0, 0, 1);
  Model<3> model;
  for (int i = 0; i < n; ++i) {
    model.F = step * model.F;
    model.Q = step * model.Q * step.transpose() + density * h * kick * kick.transpose();
  }
  return model;
}

TEST(Kinematics, SingersAccelerationIsTheIntegralOfItsNoise) {
  for (const double ratio : {0.001, 0.1, 0.24, 0.26, 3.0}) {
    const double time = 0.4;
    const double dt = ratio * time;
    Matrix<3> A;
    A << 0, 1, 0, 0, 0, 1, 0, 0, -1 / time;
    const Model<3> twin = by_small_steps(A, 2 * 9.0 / time, dt, 20000);
    const Model<3> model = kinematics::singer(dt, 3, time);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        EXPECT_NEAR(model.F(i, j), twin.F(i, j), 1e-9 * std::abs(twin.F(i, j)) + 1e-15) << ratio << ": " << i << ", " << j;
        EXPECT_NEAR(model.Q(i, j), twin.Q(i, j), 1e-6 * twin.Q(i, j)) << ratio << ": " << i << ", " << j;
      }
    }
  }
}

TEST(Kinematics, SeriesAndClosedFormsMeet) {
  const double time = 1;
  const Model<3> below = kinematics::singer(0.25, 1, time);
  const Model<3> above = kinematics::singer(std::nextafter(0.25, 1), 1, time);
  EXPECT_LE((below.F - above.F).norm(), 1e-13);
  EXPECT_LE((below.Q - above.Q).cwiseQuotient(above.Q).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Kinematics, SingersAccelerationThatNeverFadesIsConstantAcceleration) {
  const double time = 1e9;
  const Model<3> singer = kinematics::singer(0.04, std::sqrt(5 * time / 2), time);
  const Model<3> constant = kinematics::constant_acceleration(0.04, 5);
  EXPECT_LE((singer.F - constant.F).norm(), 1e-9);
  EXPECT_LE((singer.Q - constant.Q).cwiseQuotient(constant.Q).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(Kinematics, TheTurnIsACircle) {
  const double rate = 3;
  const double dt = 0.2;
  const Model<3> model = kinematics::turn(dt, rate, 1);
  // Around the origin with radius 2: position 2 (cos, sin), and so on by differentiation.
  State<2, 3> state = kinematics::at_rest<2, 3>({2, 0}, Matrix<2>::Identity(), {1, 1});
  state.mean[1] = {0, 2 * rate};
  state.mean[2] = {-2 * rate * rate, 0};
  kinematics::predict(state, model);
  const Vector<2> radial(std::cos(rate * dt), std::sin(rate * dt));
  EXPECT_LE((state.mean[0] - 2 * radial).norm(), 1e-12);
  EXPECT_LE((state.mean[2] + 2 * rate * rate * radial).norm(), 1e-11);
}

TEST(Kinematics, ASlowTurnIsConstantAcceleration) {
  const Model<3> straight = kinematics::constant_acceleration(0.04, 2);
  EXPECT_LE((kinematics::turn(0.04, 0, 2).F - straight.F).norm(), 1e-15);
  // And the series meets the closed form where they change over.
  const double rate = 1e-3 / 0.04;
  EXPECT_LE((kinematics::turn(0.04, rate * (1 - 1e-12), 2).F - kinematics::turn(0.04, rate * (1 + 1e-12), 2).F).norm(), 1e-13);
}

}  // namespace
}  // namespace marey::filter
