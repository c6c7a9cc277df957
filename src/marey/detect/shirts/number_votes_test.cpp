#include "marey/detect/shirts/number_votes.h"

#include <gtest/gtest.h>

namespace marey::detect::shirts {
namespace {

ShirtReading reading(int index, double probability, double legibility) {
  ShirtReading made{.legibility = legibility};
  made.strings.fill((1 - probability) / (kStrings - 1));
  made.strings[static_cast<std::size_t>(index)] = probability;
  return made;
}

Timestamp at(double s) {
  return timestamp_from_seconds(s);
}

TEST(NumberVotes, HasNoNumberWithoutALegibleReading) {
  NumberVotes votes;
  EXPECT_FALSE(votes.result());
  for (int i = 0; i < 20; ++i) votes.add(at(i), reading(string_index(1, 7), 0.3, 0.02));
  EXPECT_FALSE(votes.result());
}

TEST(NumberVotes, NeedsMoreThanOneLook) {
  NumberVotes votes;
  for (int i = 0; i < 5; ++i) votes.add(at(0.1 * i), reading(string_index(1, 7), 0.98, 0.9));
  ASSERT_TRUE(votes.result());
  EXPECT_EQ(votes.result()->number, 17);
  EXPECT_EQ(votes.result()->readings, 5);
  EXPECT_LT(votes.result()->probability, 0.9);
  votes.add(at(1), reading(string_index(1, 7), 0.98, 0.9));
  votes.add(at(2), reading(string_index(1, 7), 0.98, 0.9));
  EXPECT_GT(votes.result()->probability, 0.99);
}

TEST(NumberVotes, OverlookedDigitsAreVotesForTheWholeNumber) {
  NumberVotes votes;
  for (int i = 0; i < 3; ++i) votes.add(at(3 * i), reading(string_index(2, 4), 0.95, 0.9));
  votes.add(at(1), reading(string_index(-1, 2), 0.95, 0.9));
  votes.add(at(4), reading(string_index(-1, 4), 0.95, 0.9));
  EXPECT_EQ(votes.result()->number, 24);
  EXPECT_GT(votes.result()->probability, 0.95);
}

TEST(NumberVotes, TwoNumbersOnOneTrackAreNotCertain) {
  NumberVotes votes;
  for (int i = 0; i < 3; ++i) {
    votes.add(at(2 * i), reading(string_index(2, 4), 0.95, 0.9));
    votes.add(at(2 * i + 1), reading(string_index(-1, 9), 0.95, 0.9));
  }
  EXPECT_LT(votes.result()->probability, 0.9);
}

TEST(NumberVotes, IllegibleReadingsTakeNothingAway) {
  NumberVotes votes;
  for (int i = 0; i < 3; ++i) votes.add(at(i), reading(string_index(-1, 5), 0.98, 0.9));
  const double before = votes.result()->probability;
  for (int i = 3; i < 100; ++i) votes.add(at(i), reading(0, 0.9, 0.01));
  EXPECT_NEAR(votes.result()->probability, before, 0.01);
  EXPECT_EQ(votes.result()->readings, 3);
}

TEST(NumberVotes, TellsWhenTheNumberWasClearest) {
  NumberVotes votes;
  votes.add(at(1), reading(string_index(-1, 5), 0.6, 0.5));
  votes.add(at(2), reading(string_index(-1, 5), 0.99, 0.95));
  votes.add(at(3), reading(string_index(1, 5), 0.99, 0.95));
  EXPECT_EQ(votes.result()->clearest, at(votes.result()->number == 5 ? 2 : 3));
}

}  // namespace
}  // namespace marey::detect::shirts
