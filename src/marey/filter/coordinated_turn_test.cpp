#include "marey/filter/coordinated_turn.h"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "marey/filter/extended_kalman.h"
#include "marey/filter/filter.h"
#include "marey/filter/random_measurements.h"
#include "marey/filter/unscented_kalman.h"

namespace marey::filter {
namespace {

static_assert(Filter<ExtendedKalman<2>> && Filter<ExtendedKalman<3>>);
static_assert(Filter<UnscentedKalman<2>> && Filter<UnscentedKalman<3>>);

const TurnNoise kNoise{.acceleration_noise = 30, .turn_sigma = 2, .turn_time = 0.7};

template <int D>
Vector<CoordinatedTurn<D>::kSize> random_state(std::mt19937& random, double rate) {
  std::normal_distribution<double> normal;
  auto x = Vector<CoordinatedTurn<D>::kSize>::NullaryExpr([&] { return 50 * normal(random); }).eval();
  x.template tail<CoordinatedTurn<D>::kTurn>() *= rate / 50;
  return x;
}

template <int D>
void jacobian_is_the_derivative() {
  using Motion = CoordinatedTurn<D>;
  std::mt19937 random(3);
  for (const double rate : {0.0, 1e-9, 1e-4, 0.1, 3.0, 9.9, 10.1, 60.0}) {
    const auto x = random_state<D>(random, rate);
    const double dt = 0.1;
    typename Motion::Square F;
    Motion::move(x, dt, kNoise, &F);
    for (int k = 0; k < Motion::kSize; ++k) {
      const double h = 1e-5;
      auto ahead = x;
      auto behind = x;
      ahead[k] += h;
      behind[k] -= h;
      const Vector<Motion::kSize> slope = (Motion::move(ahead, dt, kNoise) - Motion::move(behind, dt, kNoise)) / (2 * h);
      EXPECT_LE((F.col(k) - slope).norm(), 2e-7 * (1 + slope.norm())) << D << "D, rate " << rate << ", entry " << k;
    }
  }
}

TEST(CoordinatedTurn, TheJacobianIsTheDerivative) {
  jacobian_is_the_derivative<2>();
  jacobian_is_the_derivative<3>();
}

TEST(CoordinatedTurn, GoesRoundACircleInThePlane) {
  // Textbook: x' = x + sin(ωT)/ω vx − (1 − cos ωT)/ω vy, and so on.
  const double w = 2.5;
  const double T = 0.3;
  CoordinatedTurn<2>::State x;
  x << 1, 2, 30, -10, w;
  const auto moved = CoordinatedTurn<2>::move(x, T, kNoise);
  const double s = std::sin(w * T);
  const double c = std::cos(w * T);
  EXPECT_NEAR(moved[0], 1 + s / w * 30 + (1 - c) / w * 10, 1e-12);
  EXPECT_NEAR(moved[1], 2 + (1 - c) / w * 30 - s / w * 10, 1e-12);
  EXPECT_NEAR(moved[2], c * 30 + s * 10, 1e-12);
  EXPECT_NEAR(moved[3], s * 30 - c * 10, 1e-12);
  EXPECT_NEAR(moved[4], w * std::exp(-T / kNoise.turn_time), 1e-12);
}

TEST(CoordinatedTurn, InSpaceItIsThePlaneOfTheVelocity) {
  CoordinatedTurn<2>::State flat;
  flat << 1, 2, 30, -10, 2.5;
  CoordinatedTurn<3>::State tall;
  tall << 1, 2, 7, 30, -10, 0, 0, 0, 2.5;
  const auto moved = CoordinatedTurn<2>::move(flat, 0.3, kNoise);
  const auto same = CoordinatedTurn<3>::move(tall, 0.3, kNoise);
  EXPECT_LE((moved.head<2>() - same.head<2>()).norm(), 1e-12);
  EXPECT_LE((moved.segment<2>(2) - same.segment<2>(3)).norm(), 1e-12);
  EXPECT_EQ(same[2], 7);
  EXPECT_EQ(same[5], 0);
}

TEST(CoordinatedTurn, SpeedIsKeptAndStepsAddUp) {
  TurnNoise lasting = kNoise;
  lasting.turn_time = 1e12;
  std::mt19937 random(5);
  for (const double rate : {0.0, 1e-7, 1.0, 20.0}) {
    const auto x = random_state<3>(random, rate);
    const auto whole = CoordinatedTurn<3>::move(x, 0.4, lasting);
    const auto half = CoordinatedTurn<3>::move(CoordinatedTurn<3>::move(x, 0.2, lasting), 0.2, lasting);
    EXPECT_LE((whole - half).norm(), 1e-9 * x.norm()) << rate;
    EXPECT_NEAR(whole.segment<3>(3).norm(), x.segment<3>(3).norm(), 1e-9 * x.norm());
  }
}

TEST(CoordinatedTurn, WithoutARateItIsTheStraightLine) {
  std::mt19937 random(6);
  for (const double rate : {0.0, 1e-300, 1e-12}) {
    const auto x = random_state<2>(random, rate);
    const auto moved = CoordinatedTurn<2>::move(x, 0.5, kNoise);
    EXPECT_LE((moved.head<2>() - x.head<2>() - 0.5 * x.segment<2>(2)).norm(), 1e-9);
  }
}

/// The slow twins: both filters as their papers write them, with the measurement's own matrices and points. Matrices of dynamic
/// size, which the compiler instantiates once.
template <int D>
struct Twin {
  using Motion = CoordinatedTurn<D>;
  using State = Vector<Motion::kSize>;
  static constexpr int N = Motion::kSize;
  Eigen::VectorXd x;
  Eigen::MatrixXd P;

  Twin(const Vector<D>& z, const Matrix<D>& R, double speed) : x(Motion::start(z)), P(Motion::start_covariance(R, speed, kNoise)) {}

  void predict_extended(double dt) {
    Matrix<N> jacobian;
    x = Motion::move(State(x), dt, kNoise, &jacobian);
    const Eigen::MatrixXd F = jacobian, Q = Motion::noise(dt, kNoise);
    P = F * P * F.transpose() + Q;
  }

  void correct_extended(const Eigen::VectorXd& z, const Eigen::MatrixXd& R) {
    const Eigen::MatrixXd H = Eigen::MatrixXd::Identity(D, N);
    const Eigen::MatrixXd S = H * P * H.transpose() + R;
    const Eigen::MatrixXd K = P * H.transpose() * S.inverse();
    x += K * (z - H * x);
    P = ((Eigen::MatrixXd::Identity(N, N) - K * H) * P).eval();
  }

  std::vector<Eigen::VectorXd> points(double kappa) const {
    const Eigen::MatrixXd root = Eigen::LLT<Eigen::MatrixXd>((N + kappa) * P).matrixL();
    std::vector<Eigen::VectorXd> all = {x};
    for (int k = 0; k < N; ++k) all.emplace_back(x + root.col(k));
    for (int k = 0; k < N; ++k) all.emplace_back(x - root.col(k));
    return all;
  }

  static double weight(std::size_t k, double kappa) { return k == 0 ? kappa / (N + kappa) : 0.5 / (N + kappa); }

  void predict_unscented(double dt, double kappa) {
    auto moved = points(kappa);
    for (auto& point : moved) point = Motion::move(State(point), dt, kNoise);
    x.setZero();
    for (std::size_t k = 0; k < moved.size(); ++k) x += weight(k, kappa) * moved[k];
    P = Motion::noise(dt, kNoise);
    for (std::size_t k = 0; k < moved.size(); ++k) P += weight(k, kappa) * (moved[k] - x) * (moved[k] - x).transpose();
  }

  void correct_unscented(const Eigen::VectorXd& z, const Eigen::MatrixXd& R, double kappa) {
    const auto all = points(kappa);
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(D);
    for (std::size_t k = 0; k < all.size(); ++k) mean += weight(k, kappa) * all[k].head(D);
    Eigen::MatrixXd S = R;
    Eigen::MatrixXd cross = Eigen::MatrixXd::Zero(N, D);
    for (std::size_t k = 0; k < all.size(); ++k) {
      const Eigen::VectorXd residual = all[k].head(D) - mean;
      S += weight(k, kappa) * residual * residual.transpose();
      cross += weight(k, kappa) * (all[k] - x) * residual.transpose();
    }
    const Eigen::MatrixXd K = cross * S.inverse();
    x += K * (z - mean);
    P -= K * S * K.transpose();
  }
};

template <typename F>
class AxisConvertingFilter : public testing::Test, public RandomMeasurements<F::dimension> {};
using Ptz = testing::Types<ExtendedKalman<2>, ExtendedKalman<3>, UnscentedKalman<2>, UnscentedKalman<3>>;
TYPED_TEST_SUITE(AxisConvertingFilter, Ptz);

TYPED_TEST(AxisConvertingFilter, AgreesWithItsTwin) {
  constexpr int D = TypeParam::dimension;
  constexpr bool unscented = std::is_same_v<TypeParam, UnscentedKalman<D>>;
  typename TypeParam::Options options;
  options.noise = kNoise;
  options.initial_speed = 40;
  double kappa = 0;
  if constexpr (unscented) options.kappa = kappa = 1.5;
  const Matrix<D> R0 = this->random_covariance(1);
  TypeParam filter(options, Vector<D>::Constant(3), R0);
  Twin<D> twin(Vector<D>::Constant(3), R0, 40);
  for (int step = 0; step < 100; ++step) {
    const double dt = 0.02 * (1 + step % 3);
    const double angle = 0.1 * step;
    Vector<D> z = Vector<D>::Constant(3) + this->random_vector(1);
    z[0] += 20 * std::cos(angle);
    z[1] += 20 * std::sin(angle);
    const Matrix<D> R = this->random_covariance(1);
    filter.predict(dt);
    if constexpr (unscented) {
      twin.predict_unscented(dt, kappa);
    } else {
      twin.predict_extended(dt);
    }
    const Matrix<D> predicted = twin.P.topLeftCorner(D, D);
    EXPECT_LE((filter.covariance() - predicted).norm(), 1e-9 * predicted.norm()) << step;
    if (step % 4 == 3) continue;
    filter.correct(z, R);
    if constexpr (unscented) {
      twin.correct_unscented(z, R, kappa);
    } else {
      twin.correct_extended(z, R);
    }
    EXPECT_LE((filter.position() - Vector<D>(twin.x.head(D))).norm(), 1e-9 * (1 + twin.x.norm())) << step;
    EXPECT_LE((filter.velocity() - Vector<D>(twin.x.segment(D, D))).norm(), 1e-8 * (1 + twin.x.norm())) << step;
  }
}

TYPED_TEST(AxisConvertingFilter, LearnsATurnAndFollowsItThroughAGap) {
  constexpr int D = TypeParam::dimension;
  typename TypeParam::Options options;
  options.noise = {.acceleration_noise = 5, .turn_sigma = 3, .turn_time = 2000};
  const double rate = 2;  // rad/s
  const double radius = 100;
  const Matrix<D> R = 0.01 * Matrix<D>::Identity();
  const auto location = [&](double t) {
    Vector<D> p = Vector<D>::Zero();
    p[0] = radius * std::cos(rate * t);
    p[1] = radius * std::sin(rate * t);
    if constexpr (D == 3) p = (Vector<3>(1, 0, 0) * p[0] + Vector<3>(0, 0.6, 0.8) * p[1]).eval();  // a tilted plane
    return p;
  };
  TypeParam filter(options, location(0), R);
  double t = 0;
  while (t < 2) {
    t += 0.02;
    filter.predict(0.02);
    filter.correct(location(t) + this->random_vector(0.1), R);
  }
  EXPECT_NEAR(filter.turn().norm(), rate, 0.1);
  filter.predict(0.5);  // a straight line would be 48 px off
  EXPECT_LE((filter.position() - location(t + 0.5)).norm(), 5);
}

TEST(UnscentedKalman, TheRootGivesItsSquareBackEvenWhereItIsSingular) {
  std::mt19937 random(9);
  std::normal_distribution<double> normal;
  for (int rank = 0; rank <= 5; ++rank) {
    const Eigen::MatrixXd A = Eigen::MatrixXd::NullaryExpr(5, rank, [&] { return normal(random); });
    const Matrix<5> P = A * A.transpose();
    const Matrix<5> L = cholesky_root<5>(P);
    EXPECT_TRUE(L.isLowerTriangular());
    // Pivots of a singular matrix are rounding's: their root is the error.
    EXPECT_LE((L * L.transpose() - P).norm(), (rank == 5 ? 1e-12 : 1e-6) * (1 + P.norm())) << rank;
  }
}

}  // namespace
}  // namespace marey::filter
