#include "marey/filter/alpha_beta.h"

#include <random>

#include <gtest/gtest.h>

#include "marey/filter/filter.h"

namespace marey::filter {
namespace {

static_assert(Filter<AlphaBeta<2>> && Filter<AlphaBeta<3>>);

TEST(AlphaBeta, FollowsThePaperByHand) {
  AlphaBeta<2> filter({.alpha = 0.5, .beta = 0.25}, {10, 20}, Matrix<2>::Identity());
  filter.predict(0.5);
  filter.correct({14, 20}, Matrix<2>::Identity());
  EXPECT_EQ(filter.position(), Vector<2>(12, 20));  // half of the residual 4
  EXPECT_EQ(filter.velocity(), Vector<2>(2, 0));    // 0.25 / 0.5 s of it
  filter.predict(1);
  EXPECT_EQ(filter.position(), Vector<2>(14, 20));
}

TEST(AlphaBeta, TheStepIsTheTimeSinceTheLastCorrection) {
  AlphaBeta<2> once({}, {0, 0}, Matrix<2>::Identity());
  AlphaBeta<2> twice = once;
  once.predict(0.2);
  twice.predict(0.15);
  twice.predict(0.05);
  once.correct({8, 0}, Matrix<2>::Identity());
  twice.correct({8, 0}, Matrix<2>::Identity());
  EXPECT_NEAR((once.velocity() - twice.velocity()).norm(), 0, 1e-12);
}

TEST(AlphaBeta, ReportsTheVarianceItHas) {
  const AlphaBetaOptions options{.alpha = 0.6, .beta = 0.2};
  std::mt19937 random(4);
  std::normal_distribution<double> noise(0, 2);
  AlphaBeta<2> filter(options, {0, 0}, 4 * Matrix<2>::Identity());
  double predicted = 0;
  double corrected = 0;
  double claimed = 0;
  constexpr int steps = 20000;
  for (int i = 0; i < steps; ++i) {
    filter.predict(0.04);
    predicted += filter.position().squaredNorm() / 2;
    claimed = filter.covariance()(0, 0);
    filter.correct({noise(random), noise(random)}, 4 * Matrix<2>::Identity());
    corrected += filter.position().squaredNorm() / 2;
  }
  EXPECT_NEAR(predicted / steps / claimed, 1, 0.05);
  EXPECT_NEAR(corrected / steps / filter.covariance()(0, 0), 1, 0.05);
}

}  // namespace
}  // namespace marey::filter
