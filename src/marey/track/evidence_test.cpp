#include "marey/track/evidence.h"

#include <gtest/gtest.h>

namespace marey::track {
namespace {

TEST(Evidence, AboutThreeConfidentObservationsConfirm) {
  const EvidenceOptions options;
  Evidence evidence(0.9, options);
  int observations = 1;
  for (; !evidence.confirmed() && observations < 10; ++observations) evidence.observe_frame(0.9, options);
  EXPECT_EQ(observations, 3);
}

TEST(Evidence, MissesRefuteSoonerWhatWasSeenLess) {
  const EvidenceOptions options;
  const auto misses_until_refuted = [&](int observations) {
    Evidence evidence(1, options);
    for (int i = 1; i < observations; ++i) evidence.observe_frame(1, options);
    int misses = 0;
    for (; !evidence.refuted() && misses < 1000; ++misses) evidence.miss(options.miss);
    return misses;
  };
  EXPECT_LT(misses_until_refuted(1), misses_until_refuted(3));
  EXPECT_EQ(misses_until_refuted(20), misses_until_refuted(200)) << "no more than `most` is kept";
}

TEST(Evidence, OnceConfirmedAlways) {
  const EvidenceOptions options;
  Evidence evidence(1, options);
  for (int i = 0; i < 5; ++i) evidence.observe_frame(1, options);
  evidence.miss(100);
  EXPECT_TRUE(evidence.confirmed());
  EXPECT_TRUE(evidence.refuted());
}

TEST(Evidence, OfTwoThatAreOneTheBetterCounts) {
  const EvidenceOptions options;
  Evidence young(1, options), old(1, options);
  for (int i = 0; i < 5; ++i) old.observe_frame(1, options);
  young.absorb(old);
  EXPECT_TRUE(young.confirmed());
}

TEST(Evidence, PatienceIsNoLongerThanATargetWasFollowed) {
  const EvidenceOptions options;
  EXPECT_DOUBLE_EQ(options.patience(2.5, 0.1), 0.1 + options.tentative_patience);
  EXPECT_DOUBLE_EQ(options.patience(2.5, 100), 2.5);
}

}  // namespace
}  // namespace marey::track
