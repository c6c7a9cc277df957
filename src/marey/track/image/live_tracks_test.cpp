#include "marey/track/image/live_tracks.h"

#include <gtest/gtest.h>

namespace marey::track::image {
namespace {

constexpr double kLiveRate = 10;  // Hz

Track<2> at(int id, double x, bool observed, bool confirmed = true) {
  Track<2> track;
  track.id = TrackId{id};
  track.position = {x, 50};
  track.covariance = Matrix<2>::Identity();
  track.provenance = observed ? Provenance::measured : Provenance::predicted;
  track.confirmed = confirmed;
  track.box = Box::from_centre(track.position, 40, 100);
  return track;
}

void add(LiveTracks& live, int frame, const std::vector<Track<2>>& tracks) {
  live.add(frame, timestamp_from_seconds(frame / kLiveRate), tracks);
}

TEST(LiveTracks, HoldsBackUnconfirmedTrack) {
  LiveTracks live(0);
  add(live, 0, {at(1, 0, true, false)});
  EXPECT_TRUE(live.next()->samples.empty());
  add(live, 1, {at(1, 0, true, true)});
  EXPECT_EQ(live.next()->samples.size(), 1u);
  EXPECT_FALSE(live.next());
}

TEST(LiveTracks, ReportsConfirmedTrackFromItsBeginning) {
  LiveTracks live(0.2);
  add(live, 0, {at(1, 0, true, false), at(2, 300, true, false)});
  EXPECT_FALSE(live.next());
  add(live, 1, {at(1, 0, true, false)});
  add(live, 2, {at(1, 0, true, true)});
  const auto first = live.next();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->index, 0);
  ASSERT_EQ(first->samples.size(), 1u);
  EXPECT_EQ(first->samples.front().track, TrackId{1});
  EXPECT_FALSE(live.next());
  EXPECT_TRUE(live.next(true));
  EXPECT_TRUE(live.next(true));
  EXPECT_FALSE(live.next(true));
}

TEST(LiveTracks, AGapThatClosesWithinTheDelayIsFilledFromBothSides) {
  LiveTracks live(0.3);
  add(live, 0, {at(1, 0, true)});
  add(live, 1, {at(1, 90, false)});
  add(live, 2, {at(1, 90, false)});
  add(live, 3, {at(1, 30, true)});
  EXPECT_EQ(live.next()->samples.front().provenance, Provenance::measured);
  const auto filled = live.next(true);
  ASSERT_EQ(filled->samples.size(), 1u);
  EXPECT_EQ(filled->samples.front().provenance, Provenance::filled);
  EXPECT_NEAR(filled->samples.front().position.x(), 10, 1e-9);
  EXPECT_NEAR(filled->samples.front().box->centre().x(), 10, 1e-9);
}

TEST(LiveTracks, ReportsUnobservedTrackWhileProbable) {
  LiveTracks live(0);
  int frame = 0;
  // One who is missed every other frame for a while teaches that gaps close.
  for (; frame < 60; ++frame) {
    add(live, frame, {at(1, 0, frame % 2 == 0)});
    live.next();
  }
  std::vector<std::size_t> reported;
  for (int k = 0; k < 10; ++k, ++frame) {
    add(live, frame, {at(1, 0, false)});
    reported.push_back(live.next()->samples.size());
  }
  EXPECT_EQ(reported.front(), 1u);  // as often before
  EXPECT_EQ(reported.back(), 0u);   // never before for this long
}

TEST(LiveTracks, APredictionThatMayBeAnywhereIsNotTold) {
  LiveTracks live(0);
  for (int frame = 0; frame < 60; ++frame) {
    add(live, frame, {at(1, 0, frame % 2 == 0)});
    live.next();
  }
  add(live, 60, {at(1, 0, true)});
  live.next();
  Track<2> lost = at(1, 0, false);
  lost.covariance *= 400;
  add(live, 61, {lost});
  EXPECT_TRUE(live.next()->samples.empty());
}

TEST(LiveTracks, UnsearchedFramesKeepThePredictedTarget) {
  LiveTracks live(0);
  for (int frame = 0; frame < 31; ++frame) {
    if (frame % 10 == 0) {
      add(live, frame, {at(1, frame, true)});
    } else {
      live.add_unsearched(frame, timestamp_from_seconds(frame / kLiveRate), std::vector{at(1, frame, false)});
    }
    const auto instant = live.next();
    ASSERT_EQ(instant->samples.size(), 1u) << frame;
    EXPECT_EQ(instant->samples.front().measured(), frame % 10 == 0) << frame;
  }
  add(live, 31, {});  // given up
  EXPECT_TRUE(live.next()->samples.empty());
  live.add_unsearched(32, timestamp_from_seconds(32 / kLiveRate), {});
  EXPECT_TRUE(live.next()->samples.empty());
}

TEST(GapSurvival, MoreGapsThatLastedLongerSayThatItIsStillThere) {
  GapSurvival survival;
  const double before = survival.still_there(1.0);
  for (int i = 0; i < 20; ++i) survival.found_again(2.0);
  const double after = survival.still_there(1.0);
  EXPECT_GT(after, before);
  EXPECT_LT(survival.still_there(3.0), after);
  for (int i = 0; i < 100; ++i) survival.lost();
  EXPECT_LT(survival.still_there(1.0), 0.5);
}

}  // namespace
}  // namespace marey::track::image
