#include "marey/filter/filters.h"

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/filter/any_filter.h"

namespace marey::filter {
namespace {

const Matrix<2> kR = Matrix<2>::Identity();

TEST(Filters, EveryOneIsNamedOnceAndFoundByItsName) {
  for (const NamedFilter& filter : named_filters()) EXPECT_EQ(name_of(filter_named(filter.name)), filter.name);
  std::vector<bool> reached(std::variant_size_v<FilterOptions>);
  for (const NamedFilter& filter : named_filters()) reached[filter.options.index()] = true;
  EXPECT_EQ(std::count(reached.begin(), reached.end(), false), 1);  // CustomFilter, which is brought from outside
}

TEST(Filters, AnUnknownNameListsTheKnownOnes) {
  try {
    filter_named("kallman");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("kallman"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("imm"), std::string::npos);
  }
}

// Through AnyFilter, which is compiled once and has each model's bits (any_filter_test.cpp): instantiating every model here would
// cost half a minute of the compiler.
template <int D>
double error_of_stationary_target(const FilterOptions& options) {
  const Vector<D> velocity = Vector<D>::Constant(30);
  AnyFilter<D> filter(options, Vector<D>::Zero(), Matrix<D>::Identity());
  Vector<D> x = Vector<D>::Zero();
  for (int i = 0; i < 60; ++i) {
    x += 0.04 * velocity;
    filter.predict(0.04);
    filter.correct(x, Matrix<D>::Identity());
  }
  return (filter.position() - x).norm();
}

TEST(Filters, EachIsReachedThroughTheRegisterInBothDimensions) {
  for (const NamedFilter& filter : named_filters()) {
    // A hundred particles that know no velocity are few, above all in space.
    const double allowed = filter.name == "condensation" ? 30 : 5;
    EXPECT_LE(error_of_stationary_target<2>(filter.options), allowed) << filter.name;
    EXPECT_LE(error_of_stationary_target<3>(filter.options), allowed) << filter.name;
  }
}

/// Largest difference, px, between the estimates of one walk in px and in a unit `factor` times as small.
template <int D>
double difference_of_units(const FilterOptions& options, double factor) {
  const Matrix<D> R = Matrix<D>::Identity();
  AnyFilter<D> one(options, Vector<D>::Zero(), R);
  AnyFilter<D> other(scaled(options, factor), Vector<D>::Zero(), factor * factor * R);
  double apart = 0;
  for (int i = 1; i < 30; ++i) {
    const Vector<D> z = Vector<D>::Constant(2.0 * i + i % 3);
    one.predict(0.04);
    other.predict(0.04);
    apart = std::max(apart, std::abs(one.gate_distance(z, R) - other.gate_distance(factor * z, factor * factor * R)));
    one.correct(z, R);
    other.correct(factor * z, factor * factor * R);
    apart = std::max(apart, (one.position() - other.position() / factor).norm());
    apart = std::max(apart, 0.04 * (one.velocity() - other.velocity() / factor).norm());
  }
  return apart;
}

TEST(Filters, NoneKnowsTheUnitOfLength) {
  for (const NamedFilter& filter : named_filters()) {
    // R of the paper's variant and the particles' spread carry their own unit, which scaled() must reach as well.
    EXPECT_LE(difference_of_units<2>(filter.options, 0.125), 1e-6) << filter.name;
    EXPECT_LE(difference_of_units<3>(filter.options, 0.125), 1e-6) << filter.name;
    EXPECT_EQ(name_of(scaled(filter.options, 3)), filter.name);
  }
}

TEST(AlphaBetaVariable, TheSearchAreaGrowsWithTheSpeedAndTheGap) {
  AlphaBetaVariable<2> filter({.first_radius = 50, .min_radius = 10, .fraction_of_path = 2}, {0, 0}, kR);
  filter.predict(0.1);
  EXPECT_EQ(filter.search_radius(), 50);
  filter.correct({10, 0}, kR);  // β = 0.8: 80 px/s
  filter.predict(0.1);
  EXPECT_NEAR(filter.search_radius(), 10 + 2 * 8, 1e-9);
  filter.predict(0.1);
  EXPECT_NEAR(filter.search_radius(), 10 + 2 * 16, 1e-9);
  EXPECT_NEAR(filter.gate_distance(filter.position() + Vector<2>(0, 42), kR), 1, 1e-9);
}

TEST(KalmanPaper, FollowsThePaperByHand) {
  KalmanPaper<2> filter({}, {100, 50}, kR);
  EXPECT_NEAR(filter.search_radius(), 100 * 10, 1e-9);  // √100 each
  filter.predict(1.0 / 30);
  // P: position 100 after one frame; velocity 100.06; both 100.
  EXPECT_NEAR(filter.covariance()(0, 0), 100, 1e-9);
  EXPECT_NEAR(filter.search_radius(), 100 * std::sqrt(100.06), 1e-9);
  EXPECT_NEAR(filter.innovation_covariance(kR)(1, 1), 100.0455, 1e-9);
  filter.correct({103, 50}, kR);
  // One frame: gain 100 / 100.2845 in x; y is tied to x by r_xy alone.
  EXPECT_NEAR(filter.velocity()[0] / 30, 3 * 100 / 100.2845, 1e-4);
}

TEST(KalmanPaper, TheSearchAreaGrowsWithTheSpeed) {
  const KalmanPaperOptions options{.r_xx = 0.1, .r_xy = 0, .r_yy = 0.1};
  KalmanPaper<2> still(options, {0, 0}, kR);
  KalmanPaper<2> moving = still;
  for (KalmanPaper<2>* filter : {&still, &moving}) {
    filter->predict(1.0 / 30);
    filter->correct({filter == &moving ? 20.0 : 0.0, 0}, kR);
    filter->predict(1.0 / 30);
  }
  const double speed = moving.velocity()[0] / 30;
  const double variance_still = std::pow(still.search_radius() / 100, 2);  // both axes alike
  const double variance_moving = std::pow(moving.search_radius() / 50 - still.search_radius() / 100, 2);
  EXPECT_NEAR(variance_moving - variance_still, 0.013 * speed, 1e-9);
}

TEST(KalmanAcceleration, FollowsAThrowWithoutLag) {
  KalmanAcceleration<2> filter({.jerk_noise = 10}, {0, 0}, 0.01 * kR);
  double t = 0;
  for (int i = 0; i < 100; ++i) {
    t += 0.02;
    filter.predict(0.02);
    filter.correct({100 * t, 490 * t * t}, 0.01 * kR);
  }
  EXPECT_NEAR(filter.acceleration()[1], 980, 1);
  filter.predict(0.2);
  EXPECT_NEAR(filter.position()[1], 490 * (t + 0.2) * (t + 0.2), 0.5);
}

TEST(Extrapolation, IsExactOnAParabolaWithUnevenSteps) {
  const auto location = [](double t) { return Vector<2>(3 - 4 * t + 5 * t * t, 2 * t * t); };
  const auto slope = [](double t) { return Vector<2>(-4 + 10 * t, 4 * t); };
  Extrapolation<2> filter({}, location(0), kR);
  double t = 0;
  for (const double dt : {0.1, 0.3, 0.05, 0.2}) {
    t += dt;
    filter.predict(dt);
    filter.correct(location(t), kR);
  }
  EXPECT_LE((filter.velocity() - slope(t)).norm(), 1e-9);
  filter.predict(0.15);
  EXPECT_LE((filter.position() - location(t + 0.15)).norm(), 1e-9);
  EXPECT_LE((filter.velocity() - slope(t + 0.15)).norm(), 1e-9);
}

TEST(Extrapolation, EvenStepsAreThreeMinusThreePlusOne) {
  Extrapolation<2> filter({}, {1, 0}, kR);
  filter.predict(0.1);
  filter.correct({2, 7}, kR);
  filter.predict(0.1);
  filter.correct({5, 3}, kR);
  filter.predict(0.1);
  EXPECT_LE((filter.position() - Vector<2>(3 * 5 - 3 * 2 + 1, 3 * 3 - 3 * 7)).norm(), 1e-9);
  EXPECT_NEAR(filter.covariance()(0, 0), 9 + 9 + 1, 1e-9);
  Extrapolation<2> straight({.bend = 0}, {1, 0}, kR);
  straight.predict(0.1);
  straight.correct({2, 7}, kR);
  straight.predict(0.1);
  straight.correct({5, 3}, kR);
  straight.predict(0.1);
  EXPECT_LE((straight.position() - Vector<2>(8, -1)).norm(), 1e-9);
}

TEST(Extrapolation, TwoMeasurementsAtOneInstantCountOnce) {
  Extrapolation<2> filter({}, {0, 0}, kR);
  filter.predict(0.1);
  filter.correct({1, 1}, kR);
  filter.predict(0);
  filter.correct({2, 2}, kR);
  EXPECT_EQ(filter.position(), Vector<2>(2, 2));
  filter.predict(0.1);
  EXPECT_LE((filter.position() - Vector<2>(4, 4)).norm(), 1e-12);
}

}  // namespace
}  // namespace marey::filter
