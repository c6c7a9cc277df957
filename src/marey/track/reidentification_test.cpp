#include <optional>

#include <gtest/gtest.h>

#include "marey/track/tracker.h"

namespace marey::track {
namespace {

constexpr double kRate = 25;

/// Somebody 60 px tall walks to the right at 50 px/s, unseen from frame 50 on for `hidden` frames, and comes out `aside` px farther
/// than he would have. Returns whether he keeps his number.
bool keeps_his_number(const TrackerOptions& options, int hidden, double aside, double size_after = 1) {
  const auto tracker = make_tracker<2>(options);
  std::optional<TrackId> before, after;
  for (int i = 0; i < 100 + hidden; ++i) {
    std::vector<Observation<2>> seen;
    if (i < 50 || i >= 50 + hidden) {
      const bool came_out = i >= 50;
      const double scale = came_out ? size_after : 1;
      const Box box = Box::from_centre({100 + 2.0 * i + (came_out ? aside : 0), 200}, 24 * scale, 60 * scale);
      seen.push_back({.value = box.centre(), .box = box});
    }
    for (const Track<2>& track : tracker->step(timestamp_from_seconds(i / kRate), seen)) {
      if (!track.confirmed || track.state != Track<2>::State::observed) continue;
      (i < 50 ? before : after) = track.id;
    }
  }
  EXPECT_TRUE(before && after);
  return before == after;
}

TrackerOptions reclaiming() {
  TrackerOptions options;
  options.steady_camera = true;
  options.reclaim = true;
  return options;
}

TEST(Reidentification, WhoWasHiddenForTwoSecondsKeepsHisNumber) {
  for (const int hidden : {10, 25, 40, 50}) {
    EXPECT_TRUE(keeps_his_number(reclaiming(), hidden, 0)) << hidden << " frames";
    EXPECT_TRUE(keeps_his_number(reclaiming(), hidden, -12)) << hidden << " frames";
  }
}

TEST(Reidentification, SomebodyElsewhereOrOfAnotherSizeIsSomebodyElse) {
  EXPECT_FALSE(keeps_his_number(reclaiming(), 30, 200));
  EXPECT_FALSE(keeps_his_number(reclaiming(), 30, 0, 2.5));
}

TEST(Reidentification, IsLeftToTheJoinWhereNotAskedFor) {
  TrackerOptions options = reclaiming();
  options.reclaim = false;
  EXPECT_FALSE(keeps_his_number(options, 50, 0));
}

}  // namespace
}  // namespace marey::track
