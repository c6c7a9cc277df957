#include "marey/pipeline/markers/track_naming.h"

#include <gtest/gtest.h>

#include "marey/core/error.h"

namespace marey::pipeline::markers {
namespace {

Instant with_tracks(const std::vector<int>& tracks, const std::vector<std::pair<int, std::string>>& named = {}) {
  Instant instant;
  for (const int track : tracks) instant.samples.emplace_back().track = TrackId{track};
  for (const auto& [track, label] : named) instant.named.push_back({TrackId{track}, label, {}});
  return instant;
}

std::vector<std::pair<int, std::string>> named_by(TrackNaming& naming, const Instant& instant) {
  std::vector<std::pair<int, std::string>> named;
  for (const TrackName& name : naming.enter({&instant, 1}).front().named) named.emplace_back(number(name.id), name.label);
  return named;
}

using Named = std::vector<std::pair<int, std::string>>;

TEST(TrackNaming, ANameIsToldOnceAndGoesBeforeTheRunsOwn) {
  TrackNaming naming;
  EXPECT_EQ(named_by(naming, with_tracks({1, 2}, {{1, "m1"}})), (Named{{1, "m1"}}));
  naming.name(TrackId{1}, "knee");
  EXPECT_EQ(named_by(naming, with_tracks({1, 2})), (Named{{1, "knee"}}));
  EXPECT_EQ(named_by(naming, with_tracks({1, 2})), Named{});
  EXPECT_EQ(named_by(naming, with_tracks({1, 2}, {{1, "m7"}})), (Named{{1, "knee"}})) << "the run may change its mind";
  naming.name(TrackId{1}, "");
  EXPECT_EQ(named_by(naming, with_tracks({1, 2})), (Named{{1, "m7"}}));
}

TEST(TrackNaming, TwoThatAreSeenTogetherHaveTwoNames) {
  TrackNaming naming;
  EXPECT_THROW(naming.name(TrackId{1}, "knee"), Error) << "no person was there yet";
  naming.enter(std::vector<Instant>{with_tracks({1, 2}, {{2, "heel"}})});
  naming.name(TrackId{1}, "knee");
  EXPECT_THROW(naming.name(TrackId{2}, "knee"), Error);
  EXPECT_THROW(naming.name(TrackId{1}, "heel"), Error);
  naming.name(TrackId{1}, "knee");
  const Instant later = with_tracks({2, 3});
  naming.enter({&later, 1});
  naming.name(TrackId{3}, "knee");  // who had it is gone
  EXPECT_EQ(named_by(naming, with_tracks({2, 3})), (Named{{3, "knee"}}));
}

TEST(TrackNaming, ReturningTrackLosesTakenName) {
  TrackNaming naming;
  named_by(naming, with_tracks({1, 2}));
  naming.name(TrackId{1}, "head");
  named_by(naming, with_tracks({2}));
  naming.name(TrackId{2}, "head");
  EXPECT_EQ(named_by(naming, with_tracks({2})), (Named{{2, "head"}}));
  EXPECT_EQ(named_by(naming, with_tracks({1, 2})), (Named{{1, ""}})) << "it is a number again";
  EXPECT_EQ(named_by(naming, with_tracks({1, 2})), Named{});
  naming.name(TrackId{2}, "");
  naming.name(TrackId{1}, "head");
  EXPECT_EQ(named_by(naming, with_tracks({1, 2})), (Named{{1, "head"}, {2, ""}}));
}

TEST(TrackNaming, TheRunsOwnNameGivesWayToTheUsers) {
  TrackNaming naming;
  named_by(naming, with_tracks({1, 2}, {{1, "head"}}));
  named_by(naming, with_tracks({2}));
  naming.name(TrackId{2}, "head");
  EXPECT_EQ(named_by(naming, with_tracks({2, 1})), (Named{{1, ""}, {2, "head"}}));
}

TEST(TrackNaming, CopiesNothingWithoutNames) {
  TrackNaming naming;
  const Instant instant = with_tracks({1}, {{1, "m1"}});
  EXPECT_EQ(naming.enter({&instant, 1}).data(), &instant);
}

}  // namespace
}  // namespace marey::pipeline::markers
