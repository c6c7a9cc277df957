#include "marey/track/roster/roster_decisions.h"

#include <gtest/gtest.h>

namespace marey::track::roster {
namespace {

Track<3> row(int id, bool observed, bool confirmed) {
  Track<3> track;
  track.id = TrackId{id};
  track.confirmed = confirmed;
  track.provenance = observed ? Provenance::measured : Provenance::predicted;
  if (observed) track.observation = 10 + id;
  return track;
}

TEST(RosterDecisions, AnOldNameIsGivenBackFromTheReturnOn) {
  RosterDecisions<3> decisions(0.05);
  for (int frame = 0; frame < 10; ++frame) {
    std::vector<Track<3>> tracks;
    tracks.reserve(2);
    tracks.push_back(row(1, frame < 3, true));
    if (frame >= 5) tracks.push_back(row(2, true, false));
    decisions.add(timestamp_from_seconds(0.01 * frame), tracks);
    if (frame == 9) decisions.rename(std::vector{RenamedTrack{TrackId{2}, TrackId{1}, timestamp_from_seconds(0.05)}});
  }
  int frame = 0;
  for (const bool all : {false, true}) {
    const auto decided = decisions.take(all);
    EXPECT_EQ(decided.size(), 5);
    for (const Decision<3>& decision : decided) {
      EXPECT_EQ(decision.now, timestamp_from_seconds(0.01 * frame));
      ASSERT_EQ(decision.tracks.size(), 1);
      EXPECT_EQ(decision.tracks[0].id, TrackId{1});
      EXPECT_TRUE(decision.tracks[0].confirmed);
      EXPECT_EQ(decision.tracks[0].observation.has_value(), frame < 3 || frame >= 5);
      EXPECT_EQ(decision.matches.size(), frame < 3 || frame >= 5 ? 1 : 0);
      ++frame;
    }
  }
}

TEST(RosterDecisions, MarkerVisibleElsewhereKeepsPosition) {
  RosterDecisions<3> decisions(1);
  decisions.add(timestamp_from_seconds(0), std::vector{row(1, true, true), row(2, true, true), row(3, true, false)});
  decisions.rename(
      std::vector{RenamedTrack{TrackId{2}, TrackId{1}, Timestamp{}}, RenamedTrack{TrackId{3}, TrackId{3}, Timestamp{}}});
  const auto decided = decisions.take(true);
  ASSERT_EQ(decided.size(), 1);
  ASSERT_EQ(decided[0].tracks.size(), 3);
  EXPECT_EQ(decided[0].tracks[1].id, TrackId{2});
  EXPECT_TRUE(decided[0].tracks[2].confirmed);
}

}  // namespace
}  // namespace marey::track::roster
