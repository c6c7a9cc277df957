#include "marey/detect/keypoints/heat_map.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace marey::detect::keypoints {
namespace {

constexpr int kReach = 3;          // cells to each side: 7 × 7
constexpr double kSureMap = 0.5;   // the window's peak from which on the map moves the place
constexpr double kOfPeak = 0.25;   // what is less is not an evidence
constexpr double kMinSigma = 0.5;  // px; by definition: no map of these cells is more exact

double likelihood(double logit) {
  return 1 / (1 + std::exp(-logit));
}

/// Sums of weights over cells.
struct TimeSteps {
  double weight = 0, peak = 0;
  Vector<2> first = Vector<2>::Zero();
  Matrix<2> second = Matrix<2>::Zero();

  void add(double w, const Vector<2>& at) {
    weight += w;
    peak = std::max(peak, w);
    first += w * at;
    second += w * at * at.transpose();
  }
};

}  // namespace

HeatPoint point_in(std::span<const float> logits, int cells, double cell, const Vector<2>& given) {
  const auto at = [&](int row, int column) {
    return static_cast<double>(
        logits[static_cast<std::size_t>(row) * static_cast<std::size_t>(cells) + static_cast<std::size_t>(column)]);
  };
  HeatPoint point{.location = given};
  const int column = static_cast<int>(std::lround(given.x() / cell - 0.5)),
            row = static_cast<int>(std::lround(given.y() / cell - 0.5));
  TimeSteps near;
  for (int r = std::max(0, row - kReach); r <= std::min(cells - 1, row + kReach); ++r) {
    for (int c = std::max(0, column - kReach); c <= std::min(cells - 1, column + kReach); ++c)
      near.add(likelihood(at(r, c)), Vector<2>(c + 0.5, r + 0.5) * cell);
  }
  if (near.peak > kSureMap) point.location = near.first / near.weight;

  const double peak = likelihood(*std::max_element(logits.begin(), logits.end()));
  const double minimum = kOfPeak * peak, least_logit = std::log(minimum / (1 - minimum));
  TimeSteps all;  // about the place
  for (int r = 0; r < cells; ++r) {
    for (int c = 0; c < cells; ++c) {
      if (const double logit = at(r, c); logit > least_logit)
        all.add(likelihood(logit), Vector<2>(c + 0.5, r + 0.5) * cell - point.location);
    }
  }
  point.covariance = Matrix<2>::Identity() * (kMinSigma * kMinSigma);
  if (all.weight > 0) point.covariance += all.second / all.weight;
  return point;
}

}  // namespace marey::detect::keypoints
