#include "marey/simulate/people/restless_video.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace marey::simulate::people {
namespace {

RestlessVideoOptions empty_video(const Unrest& unrest) {
  RestlessVideoOptions options;
  options.frames = 260;
  options.people = 0;
  options.noise = 0;
  options.degradation = {};
  options.unrest = unrest;
  return options;
}

/// Share of the image that differs by more than 8 levels between two frames.
double changed(const Unrest& unrest, int first, int second) {
  const RestlessVideo video(1, empty_video(unrest));
  cv::Mat difference;
  cv::absdiff(video.render(first).image.luma(), video.render(second).image.luma(), difference);
  return static_cast<double>(cv::countNonZero(difference > 8)) / static_cast<double>(difference.total());
}

TEST(RestlessVideo, OnlyWhatIsAskedForMoves) {
  EXPECT_EQ(changed({}, 0, 50), 0);
  EXPECT_GT(changed({.leaves_px = 3}, 0, 50), 0.03);
  EXPECT_LT(changed({.leaves_px = 3}, 0, 50), 0.35) << "trees alone";
  EXPECT_GT(changed({.jitter_px = 3}, 0, 50), 0.05);
  EXPECT_GT(changed({.lamp = 0.6}, 0, 150), 0.9);
  EXPECT_GT(changed({.clouds = 0.4}, 0, 50), 0.05);
  EXPECT_GT(changed({.rain = 80}, 0, 1), 0.005);
  EXPECT_GT(std::max(changed({.exposure_step = 0.3}, 0, 190), changed({.exposure_step = 0.3}, 0, 250)), 0.5);
  EXPECT_EQ(changed({.leaves_px = 3, .calm = 0.9}, 0, 50), 0) << "no wind yet";
}

TEST(RestlessVideo, TheTruthMovesWithTheCamera) {
  RestlessVideoOptions options;
  options.frames = 20;
  options.noise = 0;
  options.degradation = {};
  const RestlessVideo still(2, options);
  options.unrest.jitter_px = 3;
  const RestlessVideo shaken(2, options);
  double moved = 0;
  for (int i = 0; i < options.frames; ++i) {
    const cv::Mat a = still.render(i).people, b = shaken.render(i).people;
    EXPECT_NEAR(cv::countNonZero(b), cv::countNonZero(a), 0.1 * cv::countNonZero(a)) << "frame " << i;
    moved += cv::countNonZero(a != b);
  }
  EXPECT_GT(moved, 0);
}

TEST(RestlessVideo, IsTheSameForTheSameSeed) {
  RestlessVideoOptions options;
  options.frames = 3;
  options.unrest = {.leaves_px = 3, .jitter_px = 1, .exposure_step = 0.2, .lamp = 0.5, .clouds = 0.3, .rain = 20};
  const RestlessFrame a = RestlessVideo(5, options).render(2), b = RestlessVideo(5, options).render(2);
  EXPECT_EQ(cv::countNonZero(a.image.luma() != b.image.luma()), 0);
  EXPECT_EQ(cv::countNonZero(a.people != b.people), 0);
  EXPECT_GT(cv::countNonZero(a.image.luma() != RestlessVideo(6, options).render(2).image.luma()), 0);
}

}  // namespace
}  // namespace marey::simulate::people
