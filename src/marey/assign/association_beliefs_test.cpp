#include "marey/assign/association_beliefs.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "marey/assign/association_marginals.h"

namespace marey::assign {
namespace {

TEST(AssociationBeliefs, PairProbabilityEqualsItsOdds) {
  EXPECT_NEAR(association_beliefs(1, 1, std::vector<GatedPair>{{0, 0, std::log(3.0)}})[0], 0.75, 1e-9);
}

TEST(AssociationBeliefs, ChainsAreExact) {
  // Without loops messages are exact.
  std::mt19937 random(5);
  std::normal_distribution<double> gain(0, 2);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<GatedPair> pairs;
    for (int i = 0; i < 5; ++i) {
      pairs.push_back({i, i, gain(random)});
      if (i < 4) pairs.push_back({i, i + 1, gain(random)});
    }
    const std::vector<double> beliefs = association_beliefs(5, 5, pairs);
    AssociationMarginals exact;
    const auto marginals = exact.find(5, 5, pairs);
    for (std::size_t k = 0; k < pairs.size(); ++k) EXPECT_NEAR(beliefs[k], marginals[k], 0.01) << "trial " << trial;
  }
}

TEST(AssociationBeliefs, LoopsAreNearTheExactAnswer) {
  std::mt19937 random(6);
  std::normal_distribution<double> gain(0, 1.5);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<GatedPair> pairs;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) pairs.push_back({i, j, gain(random)});
    const std::vector<double> beliefs = association_beliefs(4, 4, pairs);
    AssociationMarginals exact;
    const auto marginals = exact.find(4, 4, pairs);
    for (std::size_t k = 0; k < pairs.size(); ++k) EXPECT_NEAR(beliefs[k], marginals[k], 0.2) << "trial " << trial;
  }
}

}  // namespace
}  // namespace marey::assign
