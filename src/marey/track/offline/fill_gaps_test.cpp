#include "marey/track/offline/fill_gaps.h"

#include <tuple>

#include <gtest/gtest.h>

namespace marey::track::offline {
namespace {

Timestamp frame_time(int frame) {
  return timestamp_from_seconds(frame / 30.0);
}

/// A target on a parabola, seen where `seen(frame)`.
template <typename Detected>
TrackletLog record_of(int frames, Detected&& detected) {
  TrackletLog log;
  for (int i = 0; i < frames; ++i) {
    const double t = i / 30.0;
    Track<2> track;
    track.id = TrackId{1};
    track.position = {100 + 60 * t, 50 + 90 * t * t};
    track.velocity = {60, 180 * t};
    track.box = Box::from_centre(track.position, 9, 9);
    if (!detected(i)) {
      track.position.setZero();  // a bad guess
      track.provenance = Provenance::predicted;
    }
    log.add(i, frame_time(i), std::span(&track, 1));
  }
  return log;
}

TEST(FillGaps, AGapIsFilledFromBothEnds) {
  TrackletLog log = record_of(30, [](int i) { return i < 10 || i >= 20; });
  const auto rows = rows_of_points(log);
  ASSERT_EQ(rows.size(), 30u);
  for (const TrackRow& row : rows) {
    const double t = row.frame / 30.0;
    EXPECT_NEAR(row.x, 100 + 60 * t, 1e-3);
    EXPECT_NEAR(row.y, 50 + 90 * t * t, 1e-3) << "a cubic holds a parabola";
    EXPECT_EQ(row.provenance, row.frame < 10 || row.frame >= 20 ? Provenance::measured : Provenance::filled);
    EXPECT_NEAR(row.left, row.x - 4, 1e-3);
  }
}

TEST(FillGaps, NothingIsSaidBeforeTheFirstAndAfterTheLastObservation) {
  TrackletLog log = record_of(30, [](int i) { return i >= 5 && i < 12; });
  const auto rows = rows_of_points(log);
  ASSERT_EQ(rows.size(), 7u);
  EXPECT_EQ(rows.front().frame, 5);
  EXPECT_EQ(rows.back().frame, 11);
}

TEST(FillGaps, ALongGapStaysOpenAndAFewSightingsAreNobody) {
  TrackletLog long_gap = record_of(90, [](int i) { return i < 5 || i >= 80; });
  EXPECT_EQ(rows_of_points(long_gap).size(), 15u);
  TrackletLog brief = record_of(10, [](int i) { return i < 2; });
  EXPECT_TRUE(rows_of_points(brief).empty());
}

TEST(FillGaps, TheStraightWayPutsARowInEveryFrameAlsoWhereNothingWasGuessed) {
  TrackletLog log = record_of(30, [](int i) { return i < 10 || i >= 20; });
  auto rows = log.take_tracklets().front();
  std::erase_if(rows, [](const TrackRow& row) { return row.frame == 14; });
  fill_gaps(rows, log, 1, GapInterpolation::straight);
  ASSERT_EQ(rows.size(), 30u);
  const TrackRow &from = rows[9], &to = rows[20];
  for (int frame = 10; frame < 20; ++frame) {
    const TrackRow& row = rows[static_cast<std::size_t>(frame)];
    EXPECT_EQ(row.frame, frame);
    EXPECT_FALSE(row.observed());
    EXPECT_NEAR(row.y, from.y + (to.y - from.y) * (frame - 9) / 11, 1e-3);
  }
  fill_gaps(rows, log, 0.3, GapInterpolation::straight);
  EXPECT_EQ(rows.size(), 20u) << "a longer gap stays open";
}

TEST(FillGaps, FramesBetweenSearchesAreInterpolated) {
  const std::vector<std::int32_t> searched = {0, 5, 10, 15};
  std::vector<Timestamp> times;
  for (int frame = 0; frame < 17; ++frame) times.push_back(frame_time(frame));
  std::vector<TrackRow> rows;
  for (const auto& [frame, id, x] : {std::tuple(0, 1, 0.0F), {1, 1, 50.0F}, {1, 2, 7.0F}, {3, 1, 90.0F}, {3, 2, 9.0F}}) {
    TrackRow row;
    row.frame = frame, row.id = id, row.x = x;
    rows.push_back(row);
  }
  const std::vector<TrackRow> filled = fill_between_searches(rows, searched, times);
  ASSERT_EQ(filled.size(), 9u);  // five and the four between frames 0 and 5: neither target is in the search at frame 10
  for (int frame = 0; frame <= 5; ++frame) {
    EXPECT_EQ(filled[static_cast<std::size_t>(frame)].frame, frame);
    EXPECT_NEAR(filled[static_cast<std::size_t>(frame)].x, 10 * frame, 1e-4);
    EXPECT_EQ(filled[static_cast<std::size_t>(frame)].observed(), frame % 5 == 0);
  }
  EXPECT_EQ(filled[6].id, 2);
  EXPECT_EQ(filled[7].frame, 15);
}

}  // namespace
}  // namespace marey::track::offline
