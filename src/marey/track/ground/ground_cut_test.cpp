#include "marey/track/ground/ground_cut.h"

#include <vector>

#include <gtest/gtest.h>

namespace marey::track::ground {
namespace {

constexpr CameraMask in_left = 1, in_right = 2;

/// Somebody who walks along x at 2 m/s, seen ten times a second from instant `first` to `last`; `aside`: m.
GroundTracklet seen(int track, int first, int last, CameraMask cameras, double aside = 0) {
  GroundTracklet tracklet{.runs = {{TrackId{track}, 0}}, .confirmed = true, .samples = {}};
  for (int k = first; k <= last; ++k) {
    GroundSample& sample = tracklet.samples.emplace_back();
    sample.instant = k;
    sample.place = {0.2F * static_cast<float>(k), static_cast<float>(aside)};
    sample.covariance = {0.01F, 0, 0.01F};
    sample.cameras = cameras;
  }
  return tracklet;
}

std::vector<Timestamp> ten_a_second() {
  std::vector<Timestamp> times;
  for (int k = 0; k < 200; ++k) times.push_back(timestamp_from_seconds(0.1 * k));
  return times;
}

/// The last instant of the first of two, and the first of the second.
std::pair<int, int> after_handing_over(GroundTracklet first, GroundTracklet second) {
  std::vector<GroundTracklet> both;
  both.push_back(std::move(first));
  both.push_back(std::move(second));
  both = end_before_successors(std::move(both), ten_a_second());
  EXPECT_EQ(both.size(), 2U);
  return {both[0].samples.back().instant, both[1].samples.front().instant};
}

TEST(GroundCut, WhoGoesOnInAnotherTrackEndsBeforeIt) {
  EXPECT_EQ(after_handing_over(seen(1, 0, 50, in_left), seen(2, 50, 150, in_right, 0.5)), std::pair(49, 50));
  EXPECT_EQ(after_handing_over(seen(1, 0, 52, in_left), seen(2, 50, 150, in_right, 0.5)), std::pair(49, 50));
  EXPECT_EQ(after_handing_over(seen(1, 0, 40, in_left), seen(2, 50, 150, in_right)), std::pair(40, 50)) << "nothing to do";
}

TEST(GroundCut, TwoPeopleKeepTheirSamples) {
  EXPECT_EQ(after_handing_over(seen(1, 0, 52, in_left), seen(2, 50, 150, in_left, 0.5)), std::pair(52, 50))
      << "one camera saw both";
  EXPECT_EQ(after_handing_over(seen(1, 0, 52, in_left), seen(2, 50, 150, in_right, 3)), std::pair(52, 50)) << "far apart";
  EXPECT_EQ(after_handing_over(seen(1, 0, 60, in_left), seen(2, 50, 150, in_right, 0.5)), std::pair(60, 50)) << "for a second";
  EXPECT_EQ(after_handing_over(seen(1, 50, 52, in_left), seen(2, 50, 150, in_right, 0.5)), std::pair(52, 50)) << "never alone";
}

TEST(GroundCut, IsCutWhereSomebodyEndsBesideIt) {
  const auto pieces = cut_where_others_end({seen(1, 0, 60, in_left), seen(2, 0, 150, in_left, 2)}, ten_a_second());
  ASSERT_EQ(pieces.size(), 3U);
  EXPECT_EQ(pieces[1].samples.back().instant, 60);
  EXPECT_EQ(pieces[2].samples.front().instant, 61);
  EXPECT_TRUE(pieces[1].goes_on);
  EXPECT_EQ(cut_where_others_end({seen(1, 0, 60, in_left), seen(2, 0, 150, in_left, 20)}, ten_a_second()).size(), 2U);
}

}  // namespace
}  // namespace marey::track::ground
