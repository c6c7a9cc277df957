#include "marey/edit/lowpass.h"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace marey::edit {
namespace {

constexpr double kSamplesASecond = 100;

std::vector<Vector<3>> wave(double hz, int frames) {
  std::vector<Vector<3>> path;
  for (int i = 0; i < frames; ++i) path.emplace_back(std::sin(2 * std::numbers::pi * hz * i / kSamplesASecond), 0, 1);
  return path;
}

double amplitude(const std::vector<Vector<3>>& path) {
  double maximum = 0;
  for (std::size_t i = path.size() / 4; i < 3 * path.size() / 4; ++i) maximum = std::max(maximum, std::abs(path[i].x()));
  return maximum;
}

TEST(Lowpass, HalfOfThePowerPassesAtTheCutoff) {
  std::vector<Vector<3>> path = wave(6, 800);
  lowpass(path, kSamplesASecond, 6);
  EXPECT_NEAR(amplitude(path), std::numbers::sqrt2 / 2, 0.02);
}

TEST(Lowpass, SlowPassesFastDoesNotAndNothingLags) {
  std::vector<Vector<3>> slow = wave(0.5, 800), fast = wave(25, 800);
  const std::vector<Vector<3>> before = slow;
  lowpass(slow, kSamplesASecond, 6);
  lowpass(fast, kSamplesASecond, 6);
  for (std::size_t i = 0; i < slow.size(); ++i) EXPECT_NEAR(slow[i].x(), before[i].x(), 2e-3) << i;
  EXPECT_LT(amplitude(fast), 0.01);
}

TEST(Lowpass, AStraightPathStaysAndAShortOneToo) {
  std::vector<Vector<3>> path;
  for (int i = 0; i < 50; ++i) path.emplace_back(0.1 * i, 2, -0.3 * i);
  const std::vector<Vector<3>> before = path;
  lowpass(path, kSamplesASecond, 6);
  for (std::size_t i = 0; i < path.size(); ++i) EXPECT_LT((path[i] - before[i]).norm(), 1e-4) << i;
  std::vector<Vector<3>> three(before.begin(), before.begin() + 3);
  lowpass(three, kSamplesASecond, 6);
  EXPECT_EQ(three[1], before[1]);
}

TEST(Lowpass, TheProposedCutoffTakesNoiseAndLeavesMotion) {
  const unsigned seed = std::random_device()();
  SCOPED_TRACE(fmt::format("seed {}", seed));
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, 0.01);
  std::vector<Vector<3>> truth = wave(2, 600), detected = truth;
  for (Vector<3>& location : detected) location += Vector<3>(noise(random), noise(random), noise(random));
  const auto cutoff = proposed_cutoff(detected, kSamplesASecond);
  ASSERT_TRUE(cutoff);
  EXPECT_GT(*cutoff, 2);
  EXPECT_LT(*cutoff, 15);
  const auto off = [&](const std::vector<Vector<3>>& path) {
    double sum = 0;
    for (std::size_t i = 0; i < path.size(); ++i) sum += (path[i] - truth[i]).squaredNorm();
    return std::sqrt(sum);
  };
  std::vector<Vector<3>> smooth = detected;
  lowpass(smooth, kSamplesASecond, *cutoff);
  EXPECT_LT(off(smooth), 0.6 * off(detected));
}

}  // namespace
}  // namespace marey::edit
