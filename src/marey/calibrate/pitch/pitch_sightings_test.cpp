#include "marey/calibrate/pitch/pitch_sightings.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "marey/calibrate/board/board_scene_test.h"

namespace marey::calibrate::pitch {
namespace {

const cv::Size kPaintedSize(960, 540);
const geometry::PitchSize kPaintedPitch{105, 68};

Camera above_the_corner(const Vector<3>& off = {0, 0, 0}) {
  return {geometry::BrownLens{{800, 800}, {479.5, 269.5}, {}}, board::facing(Vector<3>(30, -15, 14) + off, {30, 30, 0}),
          kPaintedSize};
}

/// Grass with the lines painted as wide as they are where the camera sees them, drawn in sixteenths of a pixel.
cv::Mat painted(const Camera& camera, const std::vector<geometry::PitchLine>& lines) {
  cv::Mat luma(kPaintedSize, CV_8UC1, cv::Scalar(80));
  for (const geometry::PitchLine& line : lines) {
    for (std::size_t i = 1; i < line.points.size(); ++i) {
      std::vector<cv::Point> corners;
      const Vector<2> aside = 0.06 * Vector<2>(-line.tangents[i].y(), line.tangents[i].x());
      for (const Vector<2>& location : {Vector<2>(line.points[i - 1] + aside), Vector<2>(line.points[i] + aside),
                                        Vector<2>(line.points[i] - aside), Vector<2>(line.points[i - 1] - aside)}) {
        const auto pixel = camera.project({location.x(), location.y(), 0});
        if (!pixel || pixel->cwiseAbs().maxCoeff() > 5000) break;
        corners.emplace_back(static_cast<int>(std::lround(16 * pixel->x())), static_cast<int>(std::lround(16 * pixel->y())));
      }
      if (corners.size() == 4) cv::fillConvexPoly(luma, corners, cv::Scalar(220), cv::LINE_AA, 4);
    }
  }
  cv::GaussianBlur(luma, luma, {}, 0.7);
  return luma;
}

const std::vector<geometry::PitchLine>& lines() {
  static const auto all = geometry::pitch_lines(kPaintedPitch, 0.25);
  return all;
}

TEST(PitchSightings, PaintIsFoundWhereItIs) {
  const Camera truth = above_the_corner();
  const auto found = find_lines(painted(truth, lines()), GroundView(truth), lines(), 10);
  ASSERT_GT(found.size(), 200U);
  std::vector<double> off;
  for (const LineSighting& one : found) {
    off.push_back(std::abs(one.normal.dot(one.pixel - *truth.project({one.ground.x(), one.ground.y(), 0}))));
    EXPECT_NEAR(one.normal.norm(), 1, 1e-9);
    EXPECT_GT(one.pixels_per_metre, 0);
    EXPECT_LT(one.line, std::ssize(lines()));
  }
  std::sort(off.begin(), off.end());
  EXPECT_LT(off[off.size() / 2], 0.4);
  EXPECT_LT(off[off.size() * 9 / 10], 1.5);
}

TEST(PitchSightings, ACameraNearlyRightIsShownWhatIsWrong) {
  const Camera truth = above_the_corner(), guess = above_the_corner({0.3, 0.2, 0.1});
  const auto found = find_lines(painted(truth, lines()), GroundView(guess), lines(), 20);
  ASSERT_GT(found.size(), 150U);
  std::vector<double> expected, detected;
  for (const LineSighting& one : found) {
    const Vector<3> location(one.ground.x(), one.ground.y(), 0);
    expected.push_back(std::abs(one.normal.dot(*truth.project(location) - *guess.project(location))));
    detected.push_back(std::abs(one.normal.dot(one.pixel - *truth.project(location))));
  }
  std::sort(expected.begin(), expected.end());
  std::sort(detected.begin(), detected.end());
  EXPECT_GT(expected[expected.size() / 2], 0.7) << "or there would be nothing to show";
  EXPECT_LT(detected[detected.size() / 2], 0.5 * expected[expected.size() / 2]);
}

TEST(PitchSightings, BareGrassAndNoiseShowNoLine) {
  const Camera camera = above_the_corner();
  EXPECT_TRUE(find_lines(cv::Mat(kPaintedSize, CV_8UC1, cv::Scalar(80)), GroundView(camera), lines(), 10).empty());
  EXPECT_TRUE(find_lines(painted(camera, lines()), GroundView(camera), {}, 10).empty());
  board::Noise noise(5);
  cv::Mat rough(kPaintedSize, CV_8UC1);
  for (int y = 0; y < rough.rows; ++y) {
    for (int x = 0; x < rough.cols; ++x) rough.at<unsigned char>(y, x) = cv::saturate_cast<unsigned char>(80 + noise.gaussian(2));
  }
  EXPECT_LT(find_lines(rough, GroundView(camera), lines(), 10).size(), 40U);
}

TEST(PitchSightings, AStripeThatIsNoPaintIsNotTaken) {
  const Camera camera = above_the_corner();
  cv::Mat luma(kPaintedSize, CV_8UC1, cv::Scalar(80));
  luma.colRange(300, 420).setTo(110);  // the mower's
  EXPECT_LT(find_lines(luma, GroundView(camera), lines(), 10).size(), 10U);
}

}  // namespace
}  // namespace marey::calibrate::pitch
