#include "marey/detect/marker_detector.h"

#include <gtest/gtest.h>

namespace marey {
namespace {
TEST(MarkerDetector, NothingInAnEmptyPicture) {
  MarkerDetector detector;
  Frame frame;
  frame.picture = Picture(cv::Mat(100, 100, CV_8UC1, cv::Scalar(12)));
  EXPECT_TRUE(detector.detect(frame, {}).detections.empty());
}
}  // namespace
}  // namespace marey
