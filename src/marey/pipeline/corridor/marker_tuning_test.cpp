#include "marey/pipeline/corridor/marker_tuning.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "marey/core/error.h"

namespace marey::pipeline::corridor {
namespace {

/// Two lamps that stand, and a marker that moves to the right.
Frame lamps_at(int frame, int lamp_level = 200) {
  cv::Mat image(120, 200, CV_8UC1, cv::Scalar(12));
  for (const cv::Point location : {cv::Point(40, 30), cv::Point(150, 90)})
    cv::circle(image, location, 4, cv::Scalar(lamp_level), cv::FILLED, cv::LINE_AA);
  cv::circle(image, {10 + 3 * frame, 60}, 4, cv::Scalar(220), cv::FILLED, cv::LINE_AA);
  Frame made;
  made.index = frame;
  made.time = timestamp_from_seconds(frame / 30.0);
  made.image = Image(image);
  return made;
}

TEST(MarkerTuning, AMaskAndAThresholdCountFromTheNextFrameOn) {
  const auto tuning = std::make_shared<MarkerTuning>(MarkerTuning::Values{});
  TunedMarkers detector({}, tuning);
  const auto found = [&](int frame) { return detector.detect(lamps_at(frame, 100), {}).detections.size(); };
  EXPECT_EQ(found(0), 3u);
  tuning->mask({30, 20, 20, 20});
  EXPECT_EQ(found(1), 2u);
  tuning->set_threshold(150);
  EXPECT_EQ(found(2), 1u) << "the lamps are fainter";
  tuning->set_threshold({});
  tuning->unmask({30, 20, 20, 20});
  EXPECT_EQ(found(3), 3u);
  tuning->mask(Mask::polygon({{30, 20}, {60, 20}, {30, 50}}));
  EXPECT_EQ(found(4), 2u);
  tuning->mask(Mask::polygon({{0, 119}, {199, 119}, {199, 0}, {198, 118}}));  // round the other lamp, not over it
  EXPECT_EQ(found(5), 2u);
}

TEST(MarkerTuning, MasksStaticLightsAndKeepsMovingMarkers) {
  const auto tuning = std::make_shared<MarkerTuning>(MarkerTuning::Values{});
  TunedMarkers detector({}, tuning);
  EXPECT_EQ(detector.detect(lamps_at(0), {}).detections.size(), 3u);
  tuning->mask_lit();
  int frame = 1;
  for (; tuning->values().learning && frame < 60; ++frame) detector.detect(lamps_at(frame), {});
  EXPECT_NEAR(frame, 33, 2) << "a second at 30 Hz";
  const auto masks = tuning->values().masks;
  ASSERT_EQ(masks.size(), 2u);
  EXPECT_TRUE(masks[0].contains({40, 30}) && masks[1].contains({150, 90}));
  const auto left = detector.detect(lamps_at(frame), {}).detections;
  ASSERT_EQ(left.size(), 1u);
  EXPECT_NEAR(left[0].centre.x(), 10 + 3 * frame, 0.2);
}

TEST(MarkerTuning, MasksAreAsManyAsThereIsRoomFor) {
  MarkerTuning tuning({});
  for (std::size_t i = 0; i < MarkerTuning::kMaxMasks - 1; ++i) tuning.mask({static_cast<int>(i), 0, 1, 1});
  tuning.learned(std::vector<cv::Rect>(5, {7, 7, 7, 7}));
  EXPECT_EQ(tuning.values().masks.size(), MarkerTuning::kMaxMasks);
  EXPECT_THROW(tuning.mask({1, 2, 3, 4}), Error);
}

TEST(MarkerTuning, OfReadyMarkersThoseInAMaskAreLeftOut) {
  std::vector<Detection> detections(3);
  detections[0].centre = {9.5, 20};   // the first pixel's border
  detections[1].centre = {19.4, 20};  // just within
  detections[2].centre = {19.6, 20};
  exclude_masked(detections, std::vector<Mask>{{10, 10, 10, 20}});
  ASSERT_EQ(detections.size(), 1u);
  EXPECT_EQ(detections[0].centre.x(), 19.6);
}

TEST(MarkerTuning, TheCommandLinesThresholdGoesBeforeTheRigs) {
  RigCamera camera;
  camera.threshold = 80;
  camera.masks = {{1, 2, 3, 4}};
  EXPECT_EQ(markers_of(camera, {}).threshold, 80.0);
  detect::markers::MarkerOptions given;
  given.threshold = 40;
  EXPECT_EQ(markers_of(camera, given).threshold, 40.0);
  EXPECT_EQ(markers_of(camera, given).masked, camera.masks);
}

}  // namespace
}  // namespace marey::pipeline::corridor
