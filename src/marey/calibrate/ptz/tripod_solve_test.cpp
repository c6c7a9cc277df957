#include "marey/calibrate/ptz/tripod_solve.h"

#include <random>

#include <gtest/gtest.h>

#include "marey/core/error.h"

namespace marey::calibrate::ptz {
namespace {

const cv::Size kClickedSize(1280, 720);
const geometry::Tripod kClickedTripod{{50, -24, 13}, {0.003, -0.004}, 0.004, 0.2, 0.015};

/// Crossings of lines that a user knows, as the tripod sees them, a pixel off.
ClickedFrame clicked(std::int64_t frame, const geometry::Heading& heading, std::mt19937& random) {
  ClickedFrame result{frame, {}};
  const Camera camera = geometry::camera_of(kClickedTripod, heading, kClickedSize);
  std::normal_distribution<double> slip(0, 1);
  for (const double x : {0.0, 5.5, 16.5, 52.5, 88.5, 99.5, 105.0}) {
    for (const double y : {0.0, 13.84, 24.84, 43.16, 54.16, 68.0}) {
      const auto pixel = camera.project({x, y, 0});
      if (pixel && camera.in_image(*pixel))
        result.locations.push_back({{x, y}, *pixel + Vector<2>(slip(random), slip(random)), ""});
    }
  }
  return result;
}

std::vector<ClickedFrame> three_frames() {
  std::mt19937 random(4);
  return {clicked(0, {-0.6, 0.2, 0.9}, random), clicked(40, {0, 0.22, 0.5}, random), clicked(90, {0.65, 0.2, 0.95}, random)};
}

TEST(TripodSolve, ClicksInThreeFramesPlaceTheTripod) {
  const std::vector<ClickedFrame> frames = three_frames();
  for (const ClickedFrame& frame : frames) ASSERT_GE(frame.locations.size(), 3u);
  const ClickedTripod found = tripod_from_clicks(frames, kClickedSize, {});
  EXPECT_FALSE(found.reflected);
  EXPECT_LT((found.tripod.location - kClickedTripod.location).norm(), 1.5);
  EXPECT_LT(found.median_px, 2);
  EXPECT_NEAR(found.headings[1].pan, 0, 0.02);
  EXPECT_NEAR(found.headings[1].log_focal, 0.5, 0.05);
}

TEST(TripodSolve, ALeftHandedFrameIsReflected) {
  std::vector<ClickedFrame> frames = three_frames();
  for (ClickedFrame& frame : frames) {
    for (ClickedPosition& click : frame.locations) click.ground.y() = 68 - click.ground.y();
  }
  const ClickedTripod found = tripod_from_clicks(frames, kClickedSize, {});
  EXPECT_TRUE(found.reflected);
  EXPECT_LT((found.tripod.location - kClickedTripod.location).norm(), 1.5);
}

TEST(TripodSolve, ClicksOnOneLineLeaveTheHandOpenAndItIsTheRightOne) {
  for (const bool turned : {false, true}) {
    std::vector<ClickedFrame> frames = three_frames();
    frames[0] = frames[1], frames[0].frame = 20;
    frames.pop_back();
    for (ClickedFrame& frame : frames) {
      std::erase_if(frame.locations, [](const ClickedPosition& click) { return click.ground.x() != 52.5; });
      ASSERT_GE(frame.locations.size(), 4u);
      if (!turned) continue;
      for (ClickedPosition& click : frame.locations) click.pixel.x() = kClickedSize.width - 1 - click.pixel.x();
    }
    const ClickedTripod found = tripod_from_clicks(frames, kClickedSize, {});
    EXPECT_FALSE(found.reflected) << turned;
    EXPECT_TRUE(found.either_hand) << turned;
    EXPECT_LT(found.tripod.location.y(), 0) << turned;
  }
  EXPECT_FALSE(tripod_from_clicks(three_frames(), kClickedSize, {}).either_hand);
}

std::string refusal(const std::vector<ClickedFrame>& frames) {
  try {
    tripod_from_clicks(frames, kClickedSize, {});
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(TripodSolve, TheWrongHalfInOneFrameIsSaid) {
  std::vector<ClickedFrame> frames = three_frames();
  for (ClickedPosition& click : frames[2].locations) click.ground.x() = 105 - click.ground.x();
  const std::string stated = refusal(frames);
  EXPECT_NE(stated.find("frame 90"), std::string::npos) << stated;
  EXPECT_NE(stated.find("other half"), std::string::npos) << stated;
}

TEST(TripodSolve, TooFewClicksAreSaid) {
  std::vector<ClickedFrame> frames = three_frames();
  frames.resize(1);
  EXPECT_NE(refusal(frames).find("2 to 4 frames"), std::string::npos);
}

}  // namespace
}  // namespace marey::calibrate::ptz
