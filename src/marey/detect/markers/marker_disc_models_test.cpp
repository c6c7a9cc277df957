#include "marey/detect/markers/marker_disc_models.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "marey/detect/kernel_targets.h"

namespace marey::detect::markers {
namespace {

double uniform(std::mt19937& random, double minimum, double maximum) {
  return std::uniform_real_distribution<double>(minimum, maximum)(random);
}

/// A disc of pixels, in eights.
MarkerWindow window_of(double reach) {
  MarkerWindow window;
  window.reach = reach;
  for (int y = -static_cast<int>(reach); y <= reach; ++y) {
    for (int x = -static_cast<int>(reach); x <= reach; ++x) {
      if (std::hypot(x, y) > reach) continue;
      window.x.push_back(static_cast<float>(x));
      window.y.push_back(static_cast<float>(y));
      window.weight.push_back(1);
    }
  }
  window.count = static_cast<int>(window.x.size());
  const std::size_t padded = (window.x.size() + 7) / 8 * 8;
  for (auto* column : {&window.x, &window.y, &window.weight}) column->resize(padded, 0);
  return window;
}

DiscsModel random_model(std::mt19937& random, int discs, bool swept, bool adds) {
  DiscsModel model{DiscsParameters(kFirstDisc + 3 * discs + (swept ? 2 : 0)), discs, swept, adds};
  model.ceiling = uniform(random, 1.1, 1.8);
  model.p[kDiscsContrast] = uniform(random, 0.6, 1.2);
  model.p[kDiscsBackground] = uniform(random, -0.1, 0.1);
  model.p[kDiscsBlur] = uniform(random, 0.4, 1.2);
  for (int i = 0; i < discs; ++i)
    model.p.segment<3>(kFirstDisc + 3 * i) << uniform(random, -4, 4), uniform(random, -4, 4), uniform(random, 1, 5);
  if (swept) model.p.tail<2>() << uniform(random, -3, 3), uniform(random, -3, 3);
  return model;
}

/// What the model says of a pixel, word by word.
double level_at(const DiscsModel& model, double x, double y) {
  const auto& p = model.p;
  const Vector<2> half = model.swept ? Vector<2>(p.tail<2>()) : Vector<2>(0, 0);
  double outside = 1, sum = 0;
  for (int i = 0; i < model.discs; ++i) {
    Vector<2> away = Vector<2>(x, y) - p.segment<2>(kFirstDisc + 3 * i);
    if (model.swept) away -= half * std::clamp(away.dot(half) / half.squaredNorm(), -1.0, 1.0);
    const double distance = std::sqrt(away.squaredNorm() + 1.0 / 12);
    const double fraction = std::erfc((distance - p[kFirstDisc + 3 * i + 2]) / p[kDiscsBlur] / std::sqrt(2.0)) / 2;
    outside *= 1 - fraction;
    sum += fraction;
  }
  const double maximum = (model.ceiling - p[kDiscsBackground]) / p[kDiscsContrast];
  return p[kDiscsBackground] + p[kDiscsContrast] * (model.adds ? std::min(sum, maximum) : 1 - outside);
}

/// All sums by differences: the brute-force reference.
DiscsNormal by_differences(const DiscsModel& model, const MarkerWindow& window, const std::vector<float>& value) {
  const Eigen::Index n = model.p.size();
  DiscsNormal normal{DiscsInformation::Zero(n, n), DiscsParameters::Zero(n)};
  for (std::size_t i = 0; i < static_cast<std::size_t>(window.count); ++i) {
    const double x = window.x[i], y = window.y[i], residual = value[i] - level_at(model, x, y);
    DiscsParameters slope(n);
    for (Eigen::Index a = 0; a < n; ++a) {
      constexpr double kStep = 1e-5;
      DiscsModel above = model, below = model;
      above.p[a] += kStep, below.p[a] -= kStep;
      if (model.adds) {  // the ceiling is kept as a share, as it is while a fit takes a step
        const double maximum = (model.ceiling - model.p[kDiscsBackground]) / model.p[kDiscsContrast];
        above.ceiling = above.p[kDiscsBackground] + maximum * above.p[kDiscsContrast];
        below.ceiling = below.p[kDiscsBackground] + maximum * below.p[kDiscsContrast];
      }
      slope[a] = (level_at(above, x, y) - level_at(below, x, y)) / (2 * kStep);
    }
    normal.information += slope * slope.transpose();
    normal.gradient += slope * residual;
    normal.squares += residual * residual;
  }
  return normal;
}

TEST(MarkerDiscModels, EveryKernelSumsWhatDifferencesDo) {
  for (std::uint32_t seed = 1; seed <= 60; ++seed) {
    std::mt19937 random(seed);
    const bool swept = seed % 3 == 0;
    const int discs = swept ? 1 + static_cast<int>(seed) % 2 : 1 + static_cast<int>(seed) % kMaxDiscs;
    const bool adds = discs == 2 && seed % 4 == 1;
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", " << discs << " discs" << (swept ? ", swept" : "")
                                    << (adds ? ", adding up" : ""));
    const DiscsModel model = random_model(random, discs, swept, adds);
    const MarkerWindow window = window_of(uniform(random, 5, 14));
    std::vector<float> value(window.x.size(), 0);
    for (float& v : value) v = static_cast<float>(uniform(random, -0.2, 1.2));
    const DiscsNormal slow = by_differences(model, window, value);
    std::optional<DiscsNormal> first;
    for (const auto& [target, kernels] : kernels_of_every_target(marker_kernels)) {
      SCOPED_TRACE(target);
      const DiscsNormal fast = linearised(model, window, value, *kernels);
      EXPECT_NEAR(fast.squares, slow.squares, 1e-4 * slow.squares);
      EXPECT_LT((fast.information - slow.information).norm(), 2e-3 * slow.information.norm());
      EXPECT_LT((fast.gradient - slow.gradient).norm(), 2e-3 * (1 + slow.gradient.norm()));
      if (first) {
        EXPECT_EQ(fast.information, first->information) << "all levels agree to the bit";
        EXPECT_EQ(fast.gradient, first->gradient);
        EXPECT_EQ(fast.squares, first->squares);
      }
      first = fast;
    }
  }
}

}  // namespace
}  // namespace marey::detect::markers
