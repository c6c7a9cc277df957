#include <optional>

#include <gtest/gtest.h>

#include "marey/track/tracker.h"

namespace marey::track::image {
namespace {

constexpr double kReidentificationRate = 25;

/// A person 60 px tall walks to the right at 50 px/s, unseen from frame 50 on for `hidden` frames, and comes out `aside` px farther
/// than it would have. Returns whether it keeps its id.
bool keeps_its_id(const TrackerOptions& options, int hidden, double aside, double size_after = 1) {
  const auto tracker = make_tracker(options);
  std::optional<TrackId> before, after;
  for (int i = 0; i < 100 + hidden; ++i) {
    std::vector<Observation<2>> detected;
    if (i < 50 || i >= 50 + hidden) {
      const bool came_out = i >= 50;
      const double scale = came_out ? size_after : 1;
      const Box box = Box::from_centre({100 + 2.0 * i + (came_out ? aside : 0), 200}, 24 * scale, 60 * scale);
      detected.push_back({.value = box.centre(), .box = box});
    }
    for (const Track<2>& track : tracker->step(timestamp_from_seconds(i / kReidentificationRate), detected)) {
      if (!track.confirmed || !track.measured()) continue;
      (i < 50 ? before : after) = track.id;
    }
  }
  EXPECT_TRUE(before && after);
  return before == after;
}

TrackerOptions reidentifying() {
  TrackerOptions options;
  options.stabilised_camera = true;
  options.reidentify = true;
  return options;
}

TEST(Reidentification, ATargetHiddenForTwoSecondsKeepsItsId) {
  for (const int hidden : {10, 25, 40, 50}) {
    EXPECT_TRUE(keeps_its_id(reidentifying(), hidden, 0)) << hidden << " frames";
    EXPECT_TRUE(keeps_its_id(reidentifying(), hidden, -12)) << hidden << " frames";
  }
}

TEST(Reidentification, APersonElsewhereOrOfAnotherSizeIsAnother) {
  EXPECT_FALSE(keeps_its_id(reidentifying(), 30, 200));
  EXPECT_FALSE(keeps_its_id(reidentifying(), 30, 0, 2.5));
}

TEST(Reidentification, IsLeftToTheJoinWhereNotAskedFor) {
  TrackerOptions options = reidentifying();
  options.reidentify = false;
  EXPECT_FALSE(keeps_its_id(options, 50, 0));
}

}  // namespace
}  // namespace marey::track::image
