#include "marey/detect/detectors.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "marey/core/error.h"

namespace marey::detect {
namespace {

Frame frame_of(const cv::Mat& pixels, int index) {
  Frame frame;
  frame.index = index;
  frame.time = timestamp_from_seconds(index / 25.0);
  frame.image = Image(pixels);
  return frame;
}

TEST(Detectors, AreMadeByNameAndSayWhatTheirBoxesMean) {
  const auto people = make_detector(detector_named("people"));
  EXPECT_TRUE(people->traits().has_foreground);
  EXPECT_TRUE(people->traits().knows_body_size);
  EXPECT_GT(people->traits().toe_m, 0);
  EXPECT_EQ(people->detection_counts().noise, 0);
  EXPECT_EQ(people->body_at({100, 100}), std::nullopt) << "nothing was seen yet";

  const auto markers = make_detector(detector_named("markers"));
  EXPECT_FALSE(markers->traits().has_foreground);
  EXPECT_FALSE(markers->traits().knows_body_size);
  EXPECT_EQ(markers->traits().toe_m, 0);
}

TEST(Detectors, NamesAndOptionsBelongTogether) {
  EXPECT_EQ(detector_names(), "people, markers, network");
  EXPECT_EQ(name_of(detector_named("markers")), "markers");
  EXPECT_EQ(name_of(detector_named("network")), "network");
  EXPECT_EQ(name_of(people::PeopleDetectorOptions{}), "people");
  try {
    detector_named("birds");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("people, markers"), std::string::npos) << error.what();
  }
}

TEST(Detectors, TakeTheOptionsTheyAreGiven) {
  cv::Mat pixels = cv::Mat::zeros(200, 300, CV_8UC1);
  cv::circle(pixels, {100, 100}, 5, 255, cv::FILLED);
  cv::circle(pixels, {200, 100}, 12, 255, cv::FILLED);
  markers::MarkerOptions options;
  options.max_area = 200;
  const auto detector = make_detector(options);
  EXPECT_EQ(detector->detect(frame_of(pixels, 0), {}).detections.size(), 1U);
  EXPECT_EQ(detector->detection_counts().misfits, 1) << "the larger disc";
}

}  // namespace
}  // namespace marey::detect
