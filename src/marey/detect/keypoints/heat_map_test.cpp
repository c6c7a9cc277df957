#include "marey/detect/keypoints/heat_map.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace marey::detect::keypoints {
namespace {

constexpr int kCells = 64;
constexpr double kCell = 4;

/// Logits of hills: likelihood `peak` at (x, y) px, `sigma` px wide.
struct Hill {
  double x, y, sigma, peak;
};
std::vector<float> map_of(const std::vector<Hill>& hills) {
  std::vector<float> logits;
  for (int row = 0; row < kCells; ++row) {
    for (int column = 0; column < kCells; ++column) {
      double likelihood = 1e-5;
      for (const Hill& hill : hills) {
        const double dx = (column + 0.5) * kCell - hill.x, dy = (row + 0.5) * kCell - hill.y;
        likelihood = std::max(likelihood, hill.peak * std::exp(-(dx * dx + dy * dy) / (2 * hill.sigma * hill.sigma)));
      }
      logits.push_back(static_cast<float>(std::log(likelihood / (1 - likelihood))));
    }
  }
  return logits;
}

TEST(HeatMap, ASureMapMovesThePoint) {
  const HeatPoint point = point_in(map_of({{101, 83, 7, 0.9}}), kCells, kCell, {104, 80});
  EXPECT_LT((point.location - Vector<2>(101, 83)).norm(), 1.5);
  const double sigma = std::sqrt(point.covariance(0, 0));
  EXPECT_GT(sigma, 4);
  EXPECT_LT(sigma, 7);
  EXPECT_NEAR(point.covariance(0, 1), 0, 1);
}

TEST(HeatMap, AnUnsureMapLeavesThePointAndWidensIt) {
  const HeatPoint point = point_in(map_of({{101, 83, 20, 0.3}}), kCells, kCell, {104, 80});
  EXPECT_EQ(point.location, Vector<2>(104, 80));
  EXPECT_GT(std::sqrt(point.covariance(0, 0)), 12);
}

TEST(HeatMap, TwoPeaksAreFarApartInTheCovariance) {
  const HeatPoint point = point_in(map_of({{60, 80, 7, 0.7}, {160, 80, 7, 0.6}}), kCells, kCell, {60, 80});
  EXPECT_GT(std::sqrt(point.covariance(0, 0)), 50);
  EXPECT_LT(std::sqrt(point.covariance(1, 1)), 8);
}

TEST(HeatMap, APointOutsideIsFarFromAllEvidence) {
  for (const Vector<2>& given : {Vector<2>(-40, 100), Vector<2>(400, 1e6), Vector<2>(-1e7, 3)}) {
    const HeatPoint point = point_in(map_of({}), kCells, kCell, given);
    EXPECT_EQ(point.location, given);
    EXPECT_GT(std::sqrt(point.covariance.trace()), 100);
  }
}

}  // namespace
}  // namespace marey::detect::keypoints
