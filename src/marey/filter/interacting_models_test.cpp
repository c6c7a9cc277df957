#include "marey/filter/interacting_models.h"

#include <gtest/gtest.h>

#include "marey/filter/filter.h"
#include "marey/filter/random_measurements.h"

namespace marey::filter {
namespace {

static_assert(Filter<InteractingModels<2>> && Filter<InteractingModels<3>>);

using Interacting = testing::Types<InteractingModels<2>, InteractingModels<3>>;

/// The slow twin: full matrices, mixing by the definition, likelihoods by the density.
template <int D>
struct TextbookMixture {
  static constexpr int N = 3 * D;
  InteractingModelsOptions options;
  std::array<Vector<N>, 4> x;
  std::array<Matrix<N>, 4> P;
  std::array<double, 4> mu;

  TextbookMixture(const InteractingModelsOptions& o, const Vector<D>& z, const Matrix<D>& R)
      : options(o), mu({o.fractions[0], o.fractions[1], o.fractions[2], 0}) {
    for (std::size_t j = 0; j < 4; ++j) {
      x[j].setZero();
      x[j].template head<D>() = z;
      P[j].setZero();
      P[j].template topLeftCorner<D, D>() = R;
      P[j].template block<D, D>(D, D).diagonal().setConstant(o.initial_speed * o.initial_speed);
      P[j].template block<D, D>(2 * D, 2 * D).diagonal().setConstant(o.acceleration * o.acceleration);
    }
  }

  static Matrix<N> widened(const Matrix<3>& small) {
    Matrix<N> full = Matrix<N>::Zero();
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) full.template block<D, D>(i * D, j * D).diagonal().setConstant(small(i, j));
    }
    return full;
  }

  Vector<N> mean() const { return mu[0] * x[0] + mu[1] * x[1] + mu[2] * x[2] + mu[3] * x[3]; }

  Matrix<N> covariance() const {
    Matrix<N> sum = Matrix<N>::Zero();
    for (std::size_t j = 0; j < 4; ++j) sum += mu[j] * (P[j] + (x[j] - mean()) * (x[j] - mean()).transpose());
    return sum;
  }

  void predict(double dt) {
    const double speed = mean().template segment<D>(D).norm();
    const double sigma = options.acceleration + options.agility * speed;
    const double stay = std::exp(-dt / options.mode_time);
    const double swerve = 1 - std::exp(-dt * options.swerve_rate);
    Matrix<4> change;
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 3; ++j) {
        const double fraction = options.fractions[static_cast<std::size_t>(j)];
        change(i, j) = (1 - swerve) * (i == 3 ? fraction : (1 - stay) * fraction + (i == j ? stay : 0));
      }
      change(i, 3) = swerve;
    }
    EXPECT_LE((change.rowwise().sum() - Vector<4>::Ones()).norm(), 1e-14);
    const auto x0 = x;
    const auto P0 = P;
    const auto mu0 = mu;
    for (std::size_t j = 0; j < 4; ++j) {
      mu[j] = 0;
      for (std::size_t i = 0; i < 4; ++i) mu[j] += mu0[i] * change(static_cast<int>(i), static_cast<int>(j));
      x[j].setZero();
      for (std::size_t i = 0; i < 4; ++i) x[j] += mu0[i] * change(static_cast<int>(i), static_cast<int>(j)) / mu[j] * x0[i];
      P[j].setZero();
      for (std::size_t i = 0; i < 4; ++i) {
        P[j] += mu0[i] * change(static_cast<int>(i), static_cast<int>(j)) / mu[j] *
                (P0[i] + (x0[i] - x[j]) * (x0[i] - x[j]).transpose());
      }
    }
    const double rate =
        turn_rate<D>(x[2].template segment<D>(D), P[2].template block<D, D>(D, D), x[2].template tail<D>(), options.turn_limit);
    std::array<kinematics::Model<3>, 4> models;
    const auto straight = kinematics::constant_velocity(dt, options.constant_noise * options.constant_noise);
    models[0].F.setZero();
    models[0].F.topLeftCorner<2, 2>() = straight.F;
    models[0].Q.topLeftCorner<2, 2>() = straight.Q;
    models[0].Q(2, 2) = sigma * sigma;
    models[1] = kinematics::singer(dt, sigma, options.acceleration_time);
    models[2] = kinematics::turn(dt, rate, 2 * sigma * sigma / options.acceleration_time);
    const double jump = options.swerve_speed + options.swerve_fraction * speed;
    models[3] = models[0];
    models[3].Q.topLeftCorner<2, 2>() << dt * dt / 3, dt / 2, dt / 2, 1;
    models[3].Q.topLeftCorner<2, 2>() *= jump * jump;
    for (std::size_t j = 0; j < 4; ++j) {
      const Matrix<N> F = widened(models[j].F);
      x[j] = (F * x[j]).eval();
      P[j] = (F * P[j] * F.transpose() + widened(models[j].Q)).eval();
    }
  }

  void correct(const Vector<D>& z, const Matrix<D>& R) {
    double sum = 0;
    for (std::size_t j = 0; j < 4; ++j) {
      const Matrix<D> S = P[j].template topLeftCorner<D, D>() + R;
      const Vector<D> residual = z - x[j].template head<D>();
      const Eigen::Matrix<double, N, D> K = P[j].template leftCols<D>() * S.inverse();
      x[j] += K * residual;
      Matrix<N> kept = Matrix<N>::Identity();
      kept.template leftCols<D>() -= K;
      P[j] = (kept * P[j] * kept.transpose() + K * R * K.transpose()).eval();
      mu[j] *= std::exp(-0.5 * residual.dot(S.inverse() * residual)) / std::sqrt(S.determinant());
      sum += mu[j];
    }
    for (double& m : mu) m /= sum;
  }
};

template <typename F>
class InteractingTwin : public testing::Test, public RandomMeasurements<F::dimension> {};
TYPED_TEST_SUITE(InteractingTwin, Interacting);

TYPED_TEST(InteractingTwin, AgreesWithTheTextbook) {
  constexpr int D = TypeParam::dimension;
  const InteractingModelsOptions options;
  const Matrix<D> R0 = this->random_covariance(0.3) + 0.1 * Matrix<D>::Identity();
  TypeParam fast(options, Vector<D>::Constant(10), R0);
  TextbookMixture<D> slow(options, Vector<D>::Constant(10), R0);
  Vector<D> location = Vector<D>::Constant(10);
  Vector<D> velocity = this->random_vector(200);
  for (int step = 0; step < 200; ++step) {
    const double dt = 0.01 * (1 + step % 5);
    if (step % 40 == 0) velocity = this->random_vector(300);
    location += dt * velocity;
    fast.predict(dt);
    slow.predict(dt);
    EXPECT_LE((fast.position() - slow.mean().template head<D>()).norm(), 1e-9 * (1 + location.norm())) << step;
    if (step % 7 != 6) {
      const Vector<D> z = location + this->random_vector(0.3);
      const Matrix<D> R = this->random_covariance(0.3) + 0.1 * Matrix<D>::Identity();
      fast.correct(z, R);
      slow.correct(z, R);
    }
    EXPECT_LE((fast.position() - slow.mean().template head<D>()).norm(), 1e-9 * (1 + location.norm())) << step;
    EXPECT_LE((fast.velocity() - slow.mean().template segment<D>(D)).norm(), 1e-8 * (1 + velocity.norm())) << step;
    const Matrix<D> covariance = slow.covariance().template topLeftCorner<D, D>();
    EXPECT_LE((fast.covariance() - covariance).norm(), 1e-8 * covariance.norm()) << step;
    for (std::size_t j = 0; j < 4; ++j) EXPECT_NEAR(fast.probabilities()[j], slow.mu[j], 1e-9) << step;
  }
}

/// Follows `place` for `duration` seconds at 100 Hz.
template <typename Location>
InteractingModels<2> tracked(Location location, double duration, const InteractingModelsOptions& options = {}) {
  std::mt19937 random(8);
  std::normal_distribution<double> normal(0, 0.1);
  const Matrix<2> R = 0.01 * Matrix<2>::Identity();
  InteractingModels<2> filter(options, location(0), R);
  for (int i = 1; i <= std::lround(100 * duration); ++i) {
    filter.predict(0.01);
    filter.correct(location(0.01 * i) + Vector<2>(normal(random), normal(random)), R);
  }
  return filter;
}

TEST(InteractingModels, KnowsWhatTheTargetIsDoing) {
  const auto stabilise = tracked([](double t) { return Vector<2>(100 * t, 50 * t); }, 1.5);
  EXPECT_GT(stabilise.probabilities()[InteractingModels<2>::kStationary], 0.6);
  const InteractingModelsOptions calm{.acceleration = 600, .agility = 1};
  const auto pulling = tracked([](double t) { return Vector<2>(600 * t * t, 0); }, 1.5, calm);
  EXPECT_LT(pulling.probabilities()[InteractingModels<2>::kStationary], 0.4);
  const auto ptz = tracked([](double t) { return Vector<2>(100 * std::cos(4 * t), 100 * std::sin(4 * t)); }, 1.5);
  EXPECT_LT(ptz.probabilities()[InteractingModels<2>::kStationary], 0.4);
  EXPECT_NEAR(ptz.velocity().norm(), 400, 20);
}

TEST(InteractingModels, ACornerIsInsideTheSearchAreaAndRecognised) {
  const auto zigzag = [](double t) { return t <= 1 ? Vector<2>(600 * t, 300 * t) : Vector<2>(1200 - 600 * t, 300 * t); };
  for (const double rate : {30.0, 120.0}) {
    const Matrix<2> R = 0.01 * Matrix<2>::Identity();
    InteractingModels<2> filter({}, zigzag(0), R);
    for (int k = 1; k <= rate + 2; ++k) {
      filter.predict(1 / rate);
      EXPECT_LE(filter.gate_distance(zigzag(k / rate), R), 1) << rate << " Hz, frame " << k;
      filter.correct(zigzag(k / rate), R);
      const auto& probabilities = filter.probabilities();
      if (k == rate) {
        EXPECT_GT(probabilities[InteractingModels<2>::kStationary], 0.6);
      } else if (k == rate + 1) {
        EXPECT_GT(probabilities[InteractingModels<2>::kSwerve], 0.9);
      }
    }
    EXPECT_LE((filter.velocity() - Vector<2>(-600, 300)).norm(), 100) << rate << " Hz";
  }
}

TEST(InteractingModels, TheLikelihoodIsADensity) {
  InteractingModels<2> filter({}, {0, 0}, Matrix<2>::Identity());
  for (int k = 1; k < 10; ++k) {
    filter.predict(0.04);
    filter.correct({4.0 * k, 0}, Matrix<2>::Identity());
  }
  filter.predict(0.04);
  double sum = 0;
  for (double x = -60; x < 60; x += 0.5) {
    for (double y = -60; y < 60; y += 0.5) {
      sum += 0.25 * std::exp(filter.log_likelihood(filter.position() + Vector<2>(x, y), Matrix<2>::Identity()));
    }
  }
  EXPECT_NEAR(sum, 1, 1e-3);
}

TEST(InteractingModels, AModelWithoutAShareOfTheTimeStaysOut) {
  InteractingModelsOptions options;
  options.fractions = {1, 0, 0};
  options.swerve_rate = 0;
  InteractingModels<2> filter(options, {0, 0}, Matrix<2>::Identity());
  for (int i = 0; i < 50; ++i) {
    filter.predict(0.04);
    filter.correct(Vector<2>(3 * i, i * i), Matrix<2>::Identity());
  }
  EXPECT_EQ(filter.probabilities()[0], 1);
  EXPECT_TRUE(filter.position().allFinite());
}

TEST(InteractingModels, AMeasurementFarFromEveryModelIsSurvived) {
  InteractingModels<2> filter({}, {0, 0}, Matrix<2>::Identity());
  filter.predict(0.04);
  filter.correct({1e12, -1e12}, 1e-6 * Matrix<2>::Identity());
  filter.predict(0.04);
  EXPECT_TRUE(filter.position().allFinite());
  double sum = 0;
  for (const double probability : filter.probabilities()) sum += probability;
  EXPECT_NEAR(sum, 1, 1e-12);
}

TEST(TurnRate, IsZeroAtRestAndHeldBackWhereTheVelocityIsUncertain) {
  const Matrix<2> sure = 1e-6 * Matrix<2>::Identity();
  EXPECT_EQ(turn_rate<2>({0, 0}, Matrix<2>::Zero(), {5, 5}, 20), 0);
  EXPECT_NEAR(turn_rate<2>({10, 0}, sure, {3, 20}, 20), 2, 1e-6);
  EXPECT_NEAR(turn_rate<2>({10, 0}, 50 * Matrix<2>::Identity(), {3, 20}, 20), 1, 1e-6);
  EXPECT_EQ(turn_rate<2>({1e-3, 0}, sure, {0, 20}, 20), 20);
  EXPECT_NEAR(turn_rate<3>({0, 10, 0}, 1e-6 * Matrix<3>::Identity(), {0, 3, -20}, 20), 2, 1e-6);
}

}  // namespace
}  // namespace marey::filter
