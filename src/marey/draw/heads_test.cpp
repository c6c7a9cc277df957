#include "marey/draw/heads.h"

#include <memory>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "marey/draw/overlay.h"

namespace marey::draw {
namespace {

Sample standing(int id, double left) {
  Sample sample;
  sample.track = TrackId{id};
  sample.box = Box{left, 100, 60, 180};
  sample.position.head<2>() = sample.box->centre();
  return sample;
}

Timestamp at_frame(int frame) {
  return timestamp_from_seconds(0.04 * frame);
}

TEST(Heads, AreInTheUpperPartOfABox) {
  const auto head = head_of(standing(1, 200), std::nullopt);
  ASSERT_TRUE(head);
  // A head 23 px high and 16 wide at the top of the box, a head's width from its middle to either side.
  EXPECT_TRUE((*head & cv::Rect2f(206, 100, 48, 23)) == cv::Rect2f(206, 100, 48, 23)) << *head;
  EXPECT_LT(head->height, 60);
  Sample lying = standing(1, 200);
  lying.box = Box{200, 100, 180, 60};
  EXPECT_GE(head_of(lying, std::nullopt)->width, 180) << "the head may be at either end";
  lying.box.reset();
  EXPECT_FALSE(head_of(lying, std::nullopt));
}

TEST(Heads, AreRoundTheFace) {
  const KeypointSet set{.name = "five", .points = {"nose", "left_eye", "right_ear", "left_hip"}, .bones = {}, .mirrored = {}};
  Sample sample = standing(1, 200);
  Keypoints<2> body;
  for (const Vector<2>& at : {Vector<2>(240, 190), Vector<2>(243, 186), Vector<2>(232, 188), Vector<2>(230, 260)})
    body.points.push_back(Keypoint<2>{.position = at});
  sample.keypoints = std::make_shared<const Keypoints<2>>(body);
  const auto head = head_of(sample, set);
  ASSERT_TRUE(head);
  EXPECT_NEAR(head->x + head->width / 2, 238.3, 0.1) << "a person who bends: not in the upper part of the box";
  EXPECT_NEAR(head->y + head->height / 2, 188, 0.1);
  EXPECT_GT(head->width, 23) << "a head, not a face alone";
  EXPECT_LT(head->height, 60);
  body.points.resize(1);
  sample.keypoints = std::make_shared<const Keypoints<2>>(body);
  EXPECT_EQ(head_of(sample, set), head_of(sample, std::nullopt)) << "one point of the face is too few";
}

TEST(Heads, AreHeldBeforeAndAfterATrack) {
  HeadsOverTime heads(std::chrono::milliseconds(400));
  std::vector<std::size_t> found;
  const auto take = [&](bool at_end) {
    while (const auto next = heads.next(at_end)) found.push_back(next->size());
  };
  for (int frame = 0; frame < 60; ++frame) {
    std::vector<Sample> samples;
    if (frame >= 20 && frame < 30) samples.push_back(standing(1, 200));
    heads.add(at_frame(frame), samples, std::nullopt);
    take(false);
  }
  EXPECT_EQ(found.size(), 49U) << "those whose next 0.4 s are known";
  take(true);
  ASSERT_EQ(found.size(), 60U);
  for (int frame = 0; frame < 60; ++frame)
    EXPECT_EQ(found[static_cast<std::size_t>(frame)], frame >= 10 && frame < 40 ? 1U : 0U) << frame;
}

TEST(Heads, NothingOfAFaceIsLeft) {
  cv::Mat noise(240, 320, CV_8UC3);
  cv::RNG random(3);
  random.fill(noise, cv::RNG::UNIFORM, 0, 255);
  const Image image = Image::from_bgr(noise);
  OverlayOptions options;
  options.bare = true;
  const std::vector<cv::Rect2f> parts{{100, 60, 40, 50}, {-20, -20, 30, 30}, {310, 230, 50, 50}};
  const Image blurred = Overlay(options).draw(image, {}, {}, {}, parts);
  const Image same = Overlay(options).draw(image, {}, {}, {});
  cv::Mat edges;
  cv::Laplacian(blurred.luma()(cv::Rect(100, 60, 40, 50)), edges, CV_32F);
  cv::Scalar mean, deviation;
  cv::meanStdDev(edges, mean, deviation);
  cv::Laplacian(image.luma()(cv::Rect(100, 60, 40, 50)), edges, CV_32F);
  cv::Scalar mean_before, deviation_before;
  cv::meanStdDev(edges, mean_before, deviation_before);
  EXPECT_LT(deviation[0], 0.05 * deviation_before[0]);
  cv::Mat difference;
  cv::absdiff(blurred.luma(), same.luma(), difference);
  for (const cv::Point corner : {cv::Point(100, 60), cv::Point(139, 60), cv::Point(100, 109), cv::Point(139, 109)})
    EXPECT_GT(cv::countNonZero(difference(cv::Rect(corner - cv::Point(2, 2), cv::Size(5, 5)))), 8) << "corners too";
  EXPECT_EQ(cv::countNonZero(difference(cv::Rect(160, 0, 100, 240))), 0) << "and nothing else";
}

}  // namespace
}  // namespace marey::draw
