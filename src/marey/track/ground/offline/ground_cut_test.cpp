#include "marey/track/ground/offline/ground_cut.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace marey::track::ground::offline {
namespace {

constexpr CameraMask in_left = 1, in_right = 2;

/// A person who walks along x at 2 m/s, seen ten times a second from instant `first` to `last`; `aside`: m.
GroundTracklet detected(int track, int first, int last, CameraMask cameras, double aside = 0) {
  GroundTracklet tracklet{.runs = {{TrackId{track}, 0}}, .confirmed = true, .samples = {}};
  for (int k = first; k <= last; ++k) {
    GroundSample& sample = tracklet.samples.emplace_back();
    sample.instant = k;
    sample.location = {0.2F * static_cast<float>(k), static_cast<float>(aside)};
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

TEST(GroundCut, TrackContinuedElsewhereEndsFirst) {
  EXPECT_EQ(after_handing_over(detected(1, 0, 50, in_left), detected(2, 50, 150, in_right, 0.5)), std::pair(49, 50));
  EXPECT_EQ(after_handing_over(detected(1, 0, 52, in_left), detected(2, 50, 150, in_right, 0.5)), std::pair(49, 50));
  EXPECT_EQ(after_handing_over(detected(1, 0, 40, in_left), detected(2, 50, 150, in_right)), std::pair(40, 50)) << "nothing to do";
}

TEST(GroundCut, TwoPeopleKeepTheirSamples) {
  EXPECT_EQ(after_handing_over(detected(1, 0, 52, in_left), detected(2, 50, 150, in_left, 0.5)), std::pair(52, 50))
      << "one camera saw both";
  EXPECT_EQ(after_handing_over(detected(1, 0, 52, in_left), detected(2, 50, 150, in_right, 3)), std::pair(52, 50)) << "far apart";
  EXPECT_EQ(after_handing_over(detected(1, 0, 60, in_left), detected(2, 50, 150, in_right, 0.5)), std::pair(60, 50))
      << "for a second";
  EXPECT_EQ(after_handing_over(detected(1, 50, 52, in_left), detected(2, 50, 150, in_right, 0.5)), std::pair(52, 50))
      << "never alone";
}

TEST(GroundCut, IsCutWhereABoxSlidesToSomebodyElse) {
  GroundTracklet slides = detected(1, 0, 150, in_left);
  slides.runs.push_back({TrackId{2}, 120});
  slides.goes_on = true;
  for (GroundSample& sample : slides.samples)
    sample.location[1] = static_cast<float>(std::clamp(0.9 * (sample.instant - 70), 0.0, 3.6));
  const auto pieces = cut_where_impossible({slides, detected(3, 0, 150, in_right, 20)}, ten_a_second());
  ASSERT_EQ(pieces.size(), 3U);
  EXPECT_NEAR(pieces[0].samples.back().instant, 70, 4);
  EXPECT_NEAR(pieces[1].samples.front().instant, 74, 4);
  EXPECT_FALSE(pieces[0].goes_on) << "it is another person";
  EXPECT_TRUE(pieces[1].goes_on);
  ASSERT_EQ(pieces[1].runs.size(), 2U);
  EXPECT_EQ(pieces[1].samples[pieces[1].runs[1].first].instant, 120);
  EXPECT_EQ(pieces[2].samples.size(), 151U) << "nothing to do";
}

TEST(GroundCut, LosesPlacesThatStrayAndComeBack) {
  GroundTracklet strays = detected(1, 0, 150, in_left);
  strays.runs.push_back({TrackId{2}, 100});
  for (int k = 70; k < 73; ++k) strays.samples[static_cast<std::size_t>(k)].location[1] = 3;
  const auto pieces = cut_where_impossible({strays}, ten_a_second());
  ASSERT_EQ(pieces.size(), 1U);
  EXPECT_LT(pieces[0].samples.size(), 149U);
  EXPECT_GT(pieces[0].samples.size(), 138U);
  for (const GroundSample& sample : pieces[0].samples) EXPECT_LT(sample.location[1], 1) << sample.instant;
  EXPECT_EQ(pieces[0].samples[pieces[0].runs[1].first].instant, 100);
}

TEST(GroundCut, ATrackMayBeginOnSomebodyElse) {
  const auto dressed = [](int others) {
    GroundTracklet tracklet = detected(1, 0, 150, in_left);
    for (GroundSample& sample : tracklet.samples) {
      const bool other = sample.instant < others;
      sample.colour = {static_cast<std::int8_t>(other ? 90 : 30), static_cast<std::int8_t>(other ? 0 : 30),
                       static_cast<std::int8_t>(other ? 0 : -60)};
      sample.colour_deviation = 5;
    }
    return tracklet;
  };
  const auto pieces = cut_at_appearance_changes({dressed(5)}, ten_a_second());
  ASSERT_EQ(pieces.size(), 2U) << "half a second";
  EXPECT_EQ(pieces[0].samples.size(), 5U);
  EXPECT_EQ(cut_at_appearance_changes({dressed(0)}, ten_a_second()).size(), 1U);
}

TEST(GroundCut, IsCutWhereSomebodyEndsBesideIt) {
  const auto pieces = cut_where_others_end({detected(1, 0, 60, in_left), detected(2, 0, 150, in_left, 2)}, ten_a_second());
  ASSERT_EQ(pieces.size(), 3U);
  EXPECT_EQ(pieces[1].samples.back().instant, 60);
  EXPECT_EQ(pieces[2].samples.front().instant, 61);
  EXPECT_TRUE(pieces[1].goes_on);
  EXPECT_EQ(cut_where_others_end({detected(1, 0, 60, in_left), detected(2, 0, 150, in_left, 20)}, ten_a_second()).size(), 2U);
}

}  // namespace
}  // namespace marey::track::ground::offline
