#include "marey/track/ground/ground_duplicates.h"

#include <vector>

#include <gtest/gtest.h>

namespace marey::track::ground {
namespace {

constexpr CameraMask by_left = 1, by_right = 2;

GroundDuplicates::Member member(int id, double x, CameraMask cameras) {
  return {.id = TrackId{id}, .position = {x, 0}, .covariance = 0.01 * Matrix<2>::Identity(), .cameras = cameras};
}

/// The pairs merged within two seconds in which two targets are seen so.
std::vector<std::pair<TrackId, TrackId>> merged(double apart, CameraMask first, CameraMask second, double disagreement = 0.3) {
  GroundDuplicates duplicates;
  std::vector<std::pair<TrackId, TrackId>> all;
  for (int i = 0; i < 50 && all.empty(); ++i) {
    const std::vector members = {member(1, 0, first), member(2, apart, second)};
    all = duplicates.find(timestamp_from_seconds(i / 25.0), members, disagreement);
  }
  return all;
}

TEST(GroundDuplicates, TwoThatCamerasFeedApartAreOne) {
  const auto merges = merged(0.6, by_left, by_right);
  ASSERT_EQ(merges.size(), 1U);
  EXPECT_EQ(merges[0], std::pair(TrackId{1}, TrackId{2})) << "the older one stays";
}

TEST(GroundDuplicates, TwoThatOneCameraSeesAreTwo) {
  EXPECT_TRUE(merged(0.6, by_left | by_right, by_right).empty());
  EXPECT_TRUE(merged(0.6, by_left, by_left).empty());
}

TEST(GroundDuplicates, TwoThatAreFartherApartThanCamerasDisagreeAreTwo) {
  EXPECT_TRUE(merged(1.8, by_left, by_right).empty());
  EXPECT_TRUE(merged(0.6, by_left, by_right, 0.05).empty());
}

TEST(GroundDuplicates, UnobservedTracksAreNotMerged) {
  EXPECT_TRUE(merged(0.1, 0, by_right).empty());
}

/// How often two targets half a metre apart are merged that cameras see by turns: at each instant the next of `masks`.
std::size_t merged_by_alternation(const std::vector<std::pair<CameraMask, CameraMask>>& masks) {
  GroundDuplicates duplicates;
  std::size_t merges = 0;
  for (std::size_t i = 0; i < 50 && merges == 0; ++i) {
    const auto& [first, second] = masks[i % masks.size()];
    const std::vector members = {member(1, 0, first), member(2, 0.5, second)};
    merges = duplicates.find(timestamp_from_seconds(static_cast<double>(i) / 25.0), members, 0.3).size();
  }
  return merges;
}

TEST(GroundDuplicates, TwoThatCamerasFeedByTurnsAreOne) {
  EXPECT_EQ(merged_by_alternation({{by_left, by_right}, {by_right, by_left}, {by_left | by_right, 0}}), 1U);
  EXPECT_EQ(merged_by_alternation({{by_left | by_right, 0}, {0, by_left | by_right}}), 1U);
}

TEST(GroundDuplicates, TwoWhoHideOneAnotherByTurnsInOneCameraAreTwo) {
  EXPECT_EQ(merged_by_alternation({{by_left, 0}, {0, by_left}}), 0U);
}

TEST(GroundDuplicates, OfThreeEachGoesOnce) {
  GroundDuplicates duplicates;
  for (int i = 0; i < 50; ++i) {
    const std::vector members = {member(1, 0, by_left), member(2, 0.3, by_right), member(3, 0.5, 4)};
    const auto& merges = duplicates.find(timestamp_from_seconds(i / 25.0), members, 0.3);
    if (merges.empty()) continue;
    for (const auto& [kept, gone] : merges) EXPECT_EQ(kept, TrackId{1}) << number(gone);
    EXPECT_EQ(merges.size(), 2U);
    return;
  }
  FAIL() << "nothing was merged";
}

}  // namespace
}  // namespace marey::track::ground
