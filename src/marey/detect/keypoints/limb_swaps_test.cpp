#include "marey/detect/keypoints/limb_swaps.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "marey/detect/keypoints/blazepose.h"

namespace marey::detect::keypoints {
namespace {

class Dice {
 public:
  explicit Dice(unsigned seed) : engine_(seed) {}
  double gaussian(double mean, double sigma) { return std::normal_distribution<double>(mean, sigma)(engine_); }
  bool chance(double probability) { return std::bernoulli_distribution(probability)(engine_); }
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }

 private:
  std::mt19937 engine_;
};

constexpr std::size_t kLeftHip = 23, kLeftAnkle = 27, kRightAnkle = 28;

/// A person 180 px tall who walks past, seen from the side and a little from ahead: legs and arms swing against each other.
Keypoints<2> walker(double t, Dice& random, double noise) {
  Keypoints<2> body;
  body.points.resize(33);
  for (std::size_t i = 0; i < 33; ++i) {
    const double side = blazepose().points[i].starts_with("left_") ? 1 : blazepose().points[i].starts_with("right_") ? -1 : 0;
    const bool leg = i >= kLeftHip, arm = i >= 11 && i < kLeftHip;
    const double down = i == 23 || i == 24   ? 90
                        : i == 25 || i == 26 ? 135
                        : leg                ? 175
                        : i == 13 || i == 14 ? 65
                        : i > 14             ? 90
                        : arm                ? 35
                                             : 10;
    const double swing = leg ? (down - 90) / 85 * 32 : arm ? -(down - 35) / 55 * 22 : 0;
    const double x = 60 * t + side * (6 + swing * std::sin(2 * M_PI * 0.9 * t));
    body.points[i] = Keypoint<2>{.position = {x + random.gaussian(0, noise), down + random.gaussian(0, noise)},
                                 .covariance = Matrix<2>::Identity() * (noise * noise)};
  }
  return body;
}

Keypoints<2> with_swapped_legs(const Keypoints<2>& body) {
  Keypoints<2> result = body;
  for (std::size_t i = kLeftHip; i < 33; ++i) result.points[i] = body.points[static_cast<std::size_t>(blazepose().mirrored[i])];
  return result;
}

/// Shares of images with the ankles' names exchanged, as the network gave them and after `lag` more images were seen; where the
/// ankles are apart.
std::pair<double, double> wrong_before_and_after(std::size_t lag, double rate) {
  constexpr int kImages = 1000;
  Dice random(7);
  LimbSwaps swaps(blazepose());
  std::vector<Keypoints<2>> truth;
  int apart = 0, before = 0, after = 0, swapped_for = 0;
  const auto check = [&](const Keypoints<2>& named, std::size_t i) {
    const Keypoints<2>& real = truth[i];
    if ((real.points[kLeftAnkle]->position - real.points[kRightAnkle]->position).norm() < 12) return;
    ++apart;
    after += named.points[kLeftAnkle]->position != real.points[kLeftAnkle]->position;
  };
  for (int i = 0; i < kImages; ++i) {
    const Keypoints<2> real = walker(i / rate, random, 2);
    truth.push_back(real);
    if (swapped_for > 0) {
      --swapped_for;
    } else if (random.chance(0.05)) {
      swapped_for = random.integer(1, 3);
    }
    before += swapped_for > 0;
    swaps.add(swapped_for > 0 ? with_swapped_legs(real) : real, 1 / rate);
    if (swaps.size() > lag) check(swaps.take(), truth.size() - 1 - lag);
  }
  while (swaps.size() > 0) {
    const std::size_t at = truth.size() - swaps.size();
    check(swaps.take(), at);
  }
  return {static_cast<double>(before) / kImages, static_cast<double>(after) / apart};
}

TEST(LimbSwaps, PutsAWalkersLegsRight) {
  const auto [before, after] = wrong_before_and_after(12, 25);
  EXPECT_GT(before, 0.07);
  EXPECT_LT(after, 0.005);
}

TEST(LimbSwaps, PutsMostRightWithoutWaiting) {
  const auto [before, after] = wrong_before_and_after(0, 25);
  EXPECT_LT(after, 0.25 * before);
}

TEST(LimbSwaps, AWrongBeginningDoesNotLast) {
  Dice random(3);
  LimbSwaps swaps(blazepose());
  for (int i = 0; i < 60; ++i) {
    const Keypoints<2> real = walker(i / 25.0, random, 2);
    swaps.add(i < 2 ? with_swapped_legs(real) : real, 1 / 25.0);
    const Keypoints<2> named = swaps.take();
    if (i > 30) {
      EXPECT_EQ(named.points[kLeftAnkle]->position, real.points[kLeftAnkle]->position) << i;
    }
  }
}

TEST(LimbSwaps, TurningPersonKeepsSides) {
  Dice random(3);
  LimbSwaps swaps(blazepose());
  for (int i = 0; i < 100; ++i) {
    Keypoints<2> body = walker(0, random, 1);  // they stand, and turn: left and right change sides in the image
    const double facing = std::cos(M_PI * i / 100);
    for (std::size_t p = 0; p < 33; ++p) {
      const double side = blazepose().points[p].starts_with("left_") ? 1 : blazepose().points[p].starts_with("right_") ? -1 : 0;
      body.points[p]->position.x() = 20 * side * facing + random.gaussian(0, 1);
    }
    swaps.add(body, 1 / 25.0);
    EXPECT_EQ(swaps.take().points[kLeftAnkle]->position, body.points[kLeftAnkle]->position) << i;
  }
}

TEST(LimbSwaps, PointsThatAreNotKnownAreLeftAlone) {
  Dice random(3);
  LimbSwaps swaps(blazepose());
  for (int i = 0; i < 10; ++i) {
    Keypoints<2> body = walker(i / 25.0, random, 1);
    body.points[kLeftAnkle].reset();
    if (i == 5) body.points.assign(33, std::nullopt);
    swaps.add(body, 1 / 25.0);
    const Keypoints<2> named = swaps.take();
    for (std::size_t p = 0; p < 33; ++p) {
      ASSERT_EQ(named.points[p].has_value(), body.points[p].has_value()) << i;
      if (named.points[p]) {
        EXPECT_EQ(named.points[p]->position, body.points[p]->position) << i;
      }
    }
  }
}

}  // namespace
}  // namespace marey::detect::keypoints
