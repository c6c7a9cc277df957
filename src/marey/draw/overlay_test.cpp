#include "marey/draw/overlay.h"

#include <vector>

#include <gtest/gtest.h>

#include "marey/draw/canvas.h"

namespace marey::draw {
namespace {

Image grey(int width, int height) {
  return Image(cv::Mat(height, width, CV_8UC1, cv::Scalar(128)));
}

Sample box_of(int id, double left, double top, Provenance provenance = Provenance::measured) {
  Sample sample;
  sample.track = TrackId{id};
  sample.box = Box{left, top, 20, 50};
  sample.position.head<2>() = sample.box->centre();
  sample.provenance = provenance;
  return sample;
}

/// How many pixels of `part` differ between two images by more than a rounding.
int changed(const Image& a, const Image& b, const cv::Rect& part) {
  cv::Mat difference;
  cv::absdiff(a.luma()(part), b.luma()(part), difference);
  return cv::countNonZero(difference > 2);
}

TEST(Canvas, PaintsTheColourThatWasAsked) {
  Canvas canvas(grey(64, 48));
  canvas.rectangle({20, 10, 20, 20}, {255, 0, 0}, 4);
  const cv::Mat bgr = canvas.take().bgr();
  const auto on_edge = bgr.at<cv::Vec3b>(20, 20);
  EXPECT_GT(on_edge[2], 240);
  EXPECT_LT(on_edge[1], 15);
  EXPECT_LT(on_edge[0], 15);
  const auto inside = bgr.at<cv::Vec3b>(20, 30);
  EXPECT_NEAR(inside[0], 128, 2);
  EXPECT_NEAR(inside[2], 128, 2);
}

TEST(Canvas, ClipsOutsideDrawingAtAnySize) {
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(3, 5), cv::Size(65, 49)}) {
    Canvas canvas(Image::from_bgr(cv::Mat(size, CV_8UC3, cv::Scalar(1, 2, 3))));
    canvas.rectangle({-10, -10, 200, 200}, {255, 0, 0}, 3);
    canvas.rectangle({500, 500, 20, 20}, {255, 0, 0}, 3);
    canvas.strokes({{{-50, -50}, {100, 100}, 1}}, {0, 255, 0}, 2);
    canvas.tag("123", {-5, -5}, {0, 0, 255}, 11);
    canvas.tag("123", {500, 500}, {0, 0, 255}, 11);
    EXPECT_EQ(canvas.take().size(), size);
  }
}

/// How many of the pixels round each point, which are grey in the image, show a name's plate.
int covered(const Image& before, const Image& after, std::span<const Sample> samples) {
  int count = 0;
  for (const Sample& sample : samples) {
    const cv::Rect round(cvRound(sample.position.x()) - 3, cvRound(sample.position.y()) - 3, 7, 7);
    count += changed(before, after, round);
  }
  return count;
}

TEST(Overlay, DrawsBonesOfWhatIsInThePicture) {
  Sample sample = box_of(1, 100, 100);
  auto body = std::make_shared<Keypoints<2>>();
  for (const Vector<2>& at : {Vector<2>(20, 20), Vector<2>(60, 20), Vector<2>(20, 60)})
    body->points.push_back(Keypoint<2>{.position = at});
  body->points[2]->presence = 0.1;
  sample.keypoints = body;
  const KeypointSet set{
      .name = "three", .points = {"nose", "left_hip", "right_hip"}, .bones = {{0, 1}, {0, 2}}, .mirrored = {0, 2, 1}};
  const Image image = grey(320, 240);
  const Image plain = Overlay().draw(image, Timestamp{}, std::vector{sample}, {});
  const Image drawn = Overlay({.keypoints = set}).draw(image, Timestamp{}, std::vector{sample}, {});
  EXPECT_GT(changed(plain, drawn, {30, 18, 20, 5}), 20);
  EXPECT_EQ(changed(plain, drawn, {15, 30, 10, 40}), 0) << "a point that is likely outside";
}

TEST(Overlay, NamesOfMarkersCoverNoMarkers) {
  std::vector<Sample> samples;
  for (int i = 0; i < 12; ++i) {
    Sample sample;
    sample.track = TrackId{i + 1};
    sample.position.head<2>() = Vector<2>(100 + 26 * (i % 4), 100 + 26 * (i / 4));
    samples.push_back(sample);
  }
  const Image image = grey(320, 240);
  const Image empty = Overlay().draw(image, Timestamp{}, {}, {}), drawn = Overlay().draw(image, Timestamp{}, samples, {});
  EXPECT_EQ(covered(empty, drawn, samples), 0);
  EXPECT_GT(changed(empty, drawn, {0, 0, 320, 240}), 12 * 60) << "the names";
}

TEST(Canvas, NeighbouringNumbersLookDifferent) {
  for (int i = 1; i < 200; ++i) {
    for (int j = i + 1; j < i + 4; ++j) {
      const Colour a = colour_of(i), b = colour_of(j);
      EXPECT_GT(std::abs(a.red - b.red) + std::abs(a.green - b.green) + std::abs(a.blue - b.blue), 80) << i << " and " << j;
    }
  }
}

TEST(Overlay, EachTargetGetsABoxANumberAndATrailThatFades) {
  Overlay overlay;
  const Image empty = Overlay().draw(grey(200, 120), Timestamp{}, {}, {});
  Image last;
  for (int i = 0; i <= 10; ++i) {
    last = overlay.draw(grey(200, 120), timestamp_from_seconds(0.1 * i), std::vector{box_of(7, 20 + 10.0 * i, 40)}, {});
  }
  EXPECT_GT(changed(empty, last, {119, 39, 22, 52}), 200) << "the box";
  EXPECT_GT(changed(empty, last, {115, 15, 30, 22}), 50) << "the number above it";
  EXPECT_GT(changed(empty, last, {40, 85, 70, 8}), 70) << "the trail behind its foot";
  last = overlay.draw(grey(200, 120), timestamp_from_seconds(20), {}, {});
  EXPECT_EQ(changed(empty, last, {0, 0, 200, 120}), 0) << "all of it has faded";
}

TEST(Overlay, PicturesOfTwelveBitsAreAsLightAsOthers) {
  Overlay overlay;
  cv::Mat deep(48, 64, CV_16UC1, cv::Scalar(2048));
  deep.at<std::uint16_t>(3, 3) = 4000;
  EXPECT_NEAR(overlay.draw(Image(deep), Timestamp{}, {}, {}).luma().at<unsigned char>(20, 20), 16 + 219 / 2, 2);
  // The next image is darker, and is drawn so.
  EXPECT_NEAR(
      overlay.draw(Image(cv::Mat(48, 64, CV_16UC1, cv::Scalar(1024))), Timestamp{}, {}, {}).luma().at<unsigned char>(20, 20),
      16 + 219 / 4, 2);
  EXPECT_NEAR(
      Overlay().draw(Image(cv::Mat(48, 64, CV_16UC1, cv::Scalar(65535))), Timestamp{}, {}, {}).luma().at<unsigned char>(20, 20),
      235, 1);
}

TEST(Overlay, AnOutlineTakesThePlaceOfTheBox) {
  const Image empty = Overlay().draw(grey(200, 120), Timestamp{}, {}, {});
  Sample sample = box_of(1, 50, 40);
  auto outline = std::make_shared<Outline>();
  outline->control_points = {{60, 40}, {70, 65}, {60, 90}, {50, 65}};
  outline->deviations.assign(4, {1, 1});
  outline->centre = {60, 65};
  sample.outline = outline;
  const Image curve = Overlay().draw(grey(200, 120), Timestamp{}, std::vector{sample}, {});
  EXPECT_EQ(changed(empty, curve, {66, 80, 8, 11}), 0) << "no corner of a box";
  EXPECT_GT(changed(empty, curve, {52, 45, 16, 40}), 60);
  outline->lines.push_back({.foot = {66, 65}, .normal = {1, 0}, .reach = 30, .finding = MeasurementLine::Finding::found});
  const Image lines = Overlay().draw(grey(200, 120), Timestamp{}, std::vector{sample}, {});
  EXPECT_GT(changed(curve, lines, {74, 64, 22, 3}), 20) << "the measurement line, outside of the curve";
}

TEST(Overlay, DrawsPredictionThinner) {
  const Image empty = Overlay().draw(grey(200, 120), Timestamp{}, {}, {});
  const cv::Rect all(0, 42, 200, 60);
  const Image detected = Overlay().draw(grey(200, 120), Timestamp{}, std::vector{box_of(1, 50, 40)}, {});
  const Image predicted = Overlay().draw(grey(200, 120), Timestamp{}, std::vector{box_of(1, 50, 40, Provenance::predicted)}, {});
  EXPECT_LT(changed(empty, predicted, all), changed(empty, detected, all));
  EXPECT_GT(changed(empty, predicted, all), 50);
}

}  // namespace
}  // namespace marey::draw
