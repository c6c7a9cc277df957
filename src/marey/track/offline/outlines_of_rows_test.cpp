#include "marey/track/offline/outlines_of_rows.h"

#include <gtest/gtest.h>

#include "support/files.h"

namespace marey::track::offline {
namespace {

Track<2> track_at(int id, double x) {
  auto outline = std::make_shared<Outline>();
  outline->control_points = {{x, 0}, {x + 4, 8}, {x, 16}, {x - 4, 8}};
  outline->deviations.assign(4, {0.5, 0.5});
  outline->centre = {x, 8};
  outline->lines.push_back({});
  Track<2> track;
  track.id = TrackId{id};
  track.outline = outline;
  return track;
}

TrackRow row_at(int frame, int id, int first_id, double x, double height, Provenance provenance) {
  TrackRow row;
  row.frame = frame;
  row.id = id;
  row.first_id = first_id;
  row.x = static_cast<float>(x);
  row.y = 8;
  row.width = 8;
  row.height = static_cast<float>(height);
  row.provenance = provenance;
  return row;
}

constexpr auto kObserved = Provenance::measured, kFilled = Provenance::filled;

std::shared_ptr<const Outline> attached(OutlinesOfRows& outlines, const TrackRow& row) {
  std::vector<Track<2>> tracks(1);
  outlines.attach(row.frame, std::vector{row}, tracks);
  return tracks[0].outline;
}

TEST(OutlinesOfRows, FollowTheNumbersThatTrackletsHadBeforeTheyWereJoined) {
  const test::TemporaryFolder folder;
  OutlineLog recording(folder / "x", true);
  recording.add(0, std::vector{track_at(3, 10), track_at(5, 100)});
  recording.add(4, std::vector{track_at(3, 200), track_at(8, 50)});
  OutlinesOfRows outlines(recording);
  EXPECT_EQ(attached(outlines, row_at(0, 1, 3, 11, 16, kObserved))->centre.x(), 10);
  EXPECT_EQ(attached(outlines, row_at(4, 1, 8, 51, 16, kObserved))->centre.x(), 50) << "joined from 3 and 8; the new 3 is another";
}

TEST(OutlinesOfRows, InAGapTheLastOutlineMovesAndGrowsWithItsRow) {
  const test::TemporaryFolder folder;
  OutlineLog recording(folder / "x", true);
  recording.add(0, std::vector{track_at(3, 10)});
  recording.add(2, std::vector{track_at(3, 500)});  // where the first pass coasted to: not trusted
  OutlinesOfRows outlines(recording);
  attached(outlines, row_at(0, 1, 3, 11, 16, kObserved));
  const auto first = attached(outlines, row_at(1, 1, 3, 21, 16, kFilled));
  EXPECT_EQ(first->centre, Vector<2>(20, 8));
  EXPECT_EQ(first->state, Outline::State::held);
  EXPECT_TRUE(first->lines.empty());
  const auto second = attached(outlines, row_at(2, 1, 3, 31, 32, kFilled));
  EXPECT_EQ(second->centre, Vector<2>(29, 8));
  EXPECT_EQ(second->control_points[2], Vector<2>(29, 24)) << "twice as large about the row's place";
  EXPECT_EQ(second->deviations[0], Vector<2>(1, 1));
}

TEST(OutlinesOfRows, ARowWithoutAnOutlineGetsNone) {
  const test::TemporaryFolder folder;
  OutlineLog recording(folder / "x", false);
  recording.add(0, std::vector{track_at(3, 10)});
  OutlinesOfRows outlines(recording);
  EXPECT_EQ(attached(outlines, row_at(0, 1, 4, 11, 16, kObserved)), nullptr);
  EXPECT_EQ(attached(outlines, row_at(1, 1, 4, 11, 16, kFilled)), nullptr);
}

}  // namespace
}  // namespace marey::track::offline
