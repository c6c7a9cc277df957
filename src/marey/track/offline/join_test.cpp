#include "marey/track/offline/join.h"

#include <map>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace marey::track::offline {
namespace {

constexpr double join_rate = 10;  // Hz

Track<2> walker(int id, double x, double y, Provenance provenance = Provenance::measured, bool confirmed = true) {
  Track<2> track;
  track.id = TrackId{id};
  track.position = {x, y};
  track.box = Box::from_centre(track.position, 32, 80);
  track.provenance = provenance;
  track.confirmed = confirmed;
  track.score = 0.9;
  return track;
}

TrackletLog record_tracks(int frames, auto&& tracks_of) {
  TrackletLog log;
  for (int k = 0; k < frames; ++k) {
    const std::vector<Track<2>> tracks = tracks_of(k);
    log.add(k, timestamp_from_seconds(k / join_rate), tracks);
  }
  return log;
}

std::set<int> ids(const std::vector<TrackRow>& rows) {
  std::set<int> all;
  for (const TrackRow& row : rows) all.insert(row.id);
  return all;
}

TEST(Join, LinksPersonBehindColumn) {
  TrackletLog log = record_tracks(60, [](int k) {
    std::vector<Track<2>> tracks;
    if (k < 20) tracks.push_back(walker(3, 100 + 5 * k, 200));
    if (k >= 35) tracks.push_back(walker(7, 100 + 5 * k, 201));
    return tracks;
  });
  const auto rows = join(log);
  EXPECT_EQ(ids(rows), std::set<int>{1});
  ASSERT_EQ(rows.size(), 60U) << "the gap is filled";
  for (const TrackRow& row : rows) {
    EXPECT_EQ(row.observed(), row.frame < 20 || row.frame >= 35);
    EXPECT_NEAR(row.x, 100 + 5 * row.frame, 2);
  }
}

TEST(Join, PersonFromElsewhereIsDistinct) {
  TrackletLog log = record_tracks(60, [](int k) {
    std::vector<Track<2>> tracks;
    if (k < 20) tracks.push_back(walker(1, 100 + 5 * k, 200));
    if (k >= 35) tracks.push_back(walker(2, 600 - 5 * k, 330));
    return tracks;
  });
  EXPECT_EQ(ids(join(log)), (std::set<int>{1, 2}));
}

TEST(Join, TwoBehindTheSameColumnAreNotMixedUp) {
  TrackletLog log = record_tracks(60, [](int k) {
    std::vector<Track<2>> tracks;
    const bool hidden = k >= 20 && k < 32;
    if (!hidden) {
      tracks.push_back(walker(k < 20 ? 1 : 4, 100 + 5 * k, 200));
      tracks.push_back(walker(k < 20 ? 2 : 5, 360 - 5 * k, 206));
    }
    return tracks;
  });
  std::map<int, std::pair<TrackRow, TrackRow>> ends;
  for (const TrackRow& row : join(log)) {
    if (!ends.contains(row.id)) ends[row.id].first = row;
    ends[row.id].second = row;
  }
  ASSERT_EQ(ends.size(), 2U);
  for (const auto& [id, end] : ends) EXPECT_EQ(end.first.x < 230, end.second.x > 230) << "turned round behind the column";
}

TEST(Join, ExcludesUnconfirmedAndBriefTracks) {
  TrackletLog log = record_tracks(30, [](int k) {
    std::vector<Track<2>> tracks{walker(1, 100 + 5 * k, 200)};
    if (k < 20) tracks.push_back(walker(2, 400, 300, Provenance::measured, false));
    if (k == 10 || k == 11) tracks.push_back(walker(3, 600, 100));
    return tracks;
  });
  const auto rows = join(log);
  EXPECT_EQ(ids(rows), std::set<int>{1});
  EXPECT_EQ(rows.size(), 30U);
}

TEST(Join, FirstFramesBeforeConfirmationAreReported) {
  TrackletLog log = record_tracks(20, [](int k) { return std::vector{walker(1, 100 + 5 * k, 200, Provenance::measured, k >= 3)}; });
  EXPECT_EQ(join(log).front().frame, 0);
}

TEST(Join, TailsWithoutAnObservationAreCut) {
  TrackletLog log = record_tracks(
      30, [](int k) { return std::vector{walker(1, 100 + 5 * k, 200, k < 18 ? Provenance::measured : Provenance::predicted)}; });
  EXPECT_EQ(join(log).back().frame, 17);
}

TEST(Join, NothingRecordedIsNothingReported) {
  TrackletLog log;
  EXPECT_TRUE(join(log).empty());
}

TEST(Join, RowsAreSmallEnoughForAWholeMatch) {
  EXPECT_LE(sizeof(TrackRow), 76U);  // 25 people for 90 minutes at 25 frames a second: 257 MB
}

TEST(Smooth, AStraightWayStaysStraightAndNoiseShrinks) {
  TrackletLog log = record_tracks(100, [](int k) { return std::vector{walker(1, 100 + 5 * k + (k % 2 == 0 ? 3 : -3), 200)}; });
  const auto rows = join(log, {.smoothing = {.location = 0.3}});
  for (const TrackRow& row : rows) {
    if (row.frame < 10 || row.frame >= 90) continue;
    EXPECT_NEAR(row.x, 100 + 5 * row.frame, 1);
    EXPECT_NEAR(row.vx, 50, 5);
    EXPECT_NEAR(row.left + row.width / 2 - 0.5, row.x, 1e-2);
  }
}

TEST(Join, AGapIsFilledWhereTheCameraWouldHaveStood) {
  TrackletLog log;
  const auto view_from_scene = [](int k) {  // the camera pans to the right, and then back
    return geometry::Similarity2::about({0, 0}, 1, 0, {k < 40 ? -8.0 * k : -320 + 8.0 * (k - 40), 0});
  };
  for (int k = 0; k < 80; ++k) {
    std::vector<Track<2>> tracks;
    if (k < 30 || k > 50) tracks.push_back(walker(k < 30 ? 1 : 2, 400 + (view_from_scene(k) * Vector<2>(2.0 * k, 0)).x(), 200));
    log.add(k, timestamp_from_seconds(k / 25.0), tracks, {}, view_from_scene(k));
  }
  int filled = 0;
  for (const TrackRow& row : join(log)) {
    EXPECT_EQ(row.id, 1);
    EXPECT_NEAR(row.x, 400 + 2.0 * row.frame + view_from_scene(row.frame).shift.x(), 3) << row.frame;
    filled += !row.observed();
  }
  EXPECT_EQ(filled, 21);
}

}  // namespace
}  // namespace marey::track::offline
