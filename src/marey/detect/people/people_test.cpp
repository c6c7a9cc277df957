#include "marey/detect/people/people.h"

#include <algorithm>
#include <array>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "support/bodies.h"

namespace marey::detect::people {
namespace {

const cv::Size kSceneImage(768, 576);

/// Foreground is what is not black: the tests draw it.
class Drawn final : public background::Background {
 public:
  Foreground apply(const Frame& frame, std::span<const Box>) override { return {frame.image.luma()}; }
};

Frame frame_of(cv::Mat mask, std::int64_t index = 0) {
  return {{}, index, timestamp_from_seconds(static_cast<double>(index) / 10), Image(std::move(mask))};
}

double height_at(double y) {
  return 20 + 0.2 * y;
}

Box walker_at(double x, double y) {
  return bodies::person(x, y, height_at(y));
}

/// A detector that has seen `frames` frames of people who walk alone.
PeopleDetector trained(int frames, unsigned seed) {
  PeopleDetector detector(std::make_unique<Drawn>());
  std::mt19937 random(seed);
  std::vector<Frame> samples;
  for (int i = 0; i < frames; ++i) {
    cv::Mat mask = cv::Mat::zeros(kSceneImage, CV_8UC1);
    for (int column = 0; column < 5; ++column) {
      bodies::draw(mask, walker_at(80 + 150 * column + bodies::uniform(random, -20, 20), bodies::uniform(random, 150, 560)),
                   bodies::uniform(random, 0, 1));
    }
    samples.push_back(frame_of(mask, i));
  }
  detector.prime(samples);
  return detector;
}

int found(const std::vector<Detection>& detections, const std::vector<Box>& truth, double minimum) {
  return static_cast<int>(std::count_if(truth.begin(), truth.end(), [&](const Box& one) {
    return std::any_of(detections.begin(), detections.end(),
                       [&](const Detection& d) { return geometry::iou(d.box, one) >= minimum; });
  }));
}

TEST(PeopleDetector, LearnsTheSizeWhilePrimed) {
  const PeopleDetector detector = trained(30, 1);
  for (const double y : {200.0, 350.0, 500.0}) {
    EXPECT_NEAR(detector.size_at(384, y).value().height / height_at(y), 1, 0.05) << y;
  }
}

TEST(PeopleDetector, FindsPeopleAloneInGroupsInPiecesAndAtTheBorder) {
  PeopleDetector detector = trained(30, 2);
  cv::Mat mask = cv::Mat::zeros(kSceneImage, CV_8UC1);
  const std::vector<Box> truth = {walker_at(100, 300), walker_at(300, 400), walker_at(330, 405), walker_at(362, 398),
                                  walker_at(550, 350), walker_at(3, 450),   walker_at(650, 595)};
  for (const Box& one : truth) bodies::draw(mask, one);
  mask(cv::Rect(500, 300, 100, 8)).setTo(0);  // the fifth is in two pieces
  const auto result = detector.detect(frame_of(mask), {});
  EXPECT_EQ(result.detections.size(), truth.size());
  std::vector<Box> inside;
  for (const Box& one : truth) inside.push_back(geometry::intersection(one, {0, 0, 768, 576}));
  EXPECT_EQ(found(result.detections, inside, 0.55), static_cast<int>(truth.size()));
  const auto in_group =
      std::count_if(result.detections.begin(), result.detections.end(), [](const Detection& d) { return d.group.has_value(); });
  EXPECT_EQ(in_group, 3);
  EXPECT_EQ(detector.counts().shared, 3);
}

/// A person `height` px tall who walks across and, where that is possible, in from below, in pieces: stripes of the body look like
/// the scene.
cv::Mat in_pieces(cv::Size image, double height, int i) {
  cv::Mat mask = cv::Mat::zeros(image, CV_8UC1);
  const double x = image.width * (0.2 + 0.02 * i), foot = std::max(image.height * (1.15 - 0.012 * i), 0.06 * image.height + height);
  bodies::draw(mask, bodies::person(x, foot, height), 0.3 + 0.4 * (i % 2));
  for (int stripe = 0; stripe < 3; ++stripe) {
    const int row = static_cast<int>(foot - height * (0.25 + 0.22 * stripe)), tall = std::max(1, static_cast<int>(0.03 * height));
    if (row > 0 && row + tall < image.height) mask.rowRange(row, row + tall).setTo(0);
  }
  return mask;
}

TEST(PeopleDetector, MergesPiecesOfPersonAtAnySize) {
  for (const double height : {40.0, 100.0, 400.0, 700.0, 1200.0}) {
    SCOPED_TRACE(height);
    PeopleDetector detector(std::make_unique<Drawn>());
    std::vector<Frame> samples;
    for (int i = 0; i < 30; ++i) samples.push_back(frame_of(in_pieces(kSceneImage, height, i), i));
    detector.prime(samples);
    for (int i = 0; i < 30; ++i) {
      const cv::Mat mask = in_pieces(kSceneImage, height, i);
      const auto found = detector.detect(frame_of(mask, i), {}).detections;
      EXPECT_LE(found.size(), 1u) << i;
    }
  }
}

/// What is small (a dog, leaves) may come first, and its size be taken for a person's: it must not divide a person for ever.
TEST(PeopleDetector, ASizeThatWasTakenForTooSmallIsGivenUp) {
  PeopleDetector detector(std::make_unique<Drawn>());
  std::mt19937 random(3);
  std::vector<Frame> samples;
  for (int i = 0; i < 30; ++i) {
    cv::Mat mask = cv::Mat::zeros(kSceneImage, CV_8UC1);
    bodies::draw(mask, bodies::person(60 + 22 * i, bodies::uniform(random, 100, 560), 40));
    samples.push_back(frame_of(mask, i));
  }
  detector.prime(samples);
  ASSERT_NEAR(detector.size_at(384, 400).value().height, 40, 5);
  std::vector<Expected> expected;
  std::size_t found = 0;
  for (int i = 0; i < 200; ++i) {
    cv::Mat mask = cv::Mat::zeros(kSceneImage, CV_8UC1);
    bodies::draw(mask, bodies::person(120 + 2.6 * i, 500 + bodies::uniform(random, -40, 40), 400), bodies::uniform(random, 0, 1));
    const auto result = detector.detect(frame_of(mask, 100 + i), expected);
    expected.clear();
    for (const Detection& one : result.detections) expected.push_back({one.box});
    found = result.detections.size();
  }
  EXPECT_EQ(found, 1u);
}

TEST(PeopleDetector, ShadowsAtTheFeetDoNotWidenABox) {
  PeopleDetector detector = trained(30, 3);
  cv::Mat mask = cv::Mat::zeros(kSceneImage, CV_8UC1);
  const Box truth = walker_at(300, 400);
  bodies::draw(mask, truth, 0.2);
  cv::rectangle(mask, cv::Point(310, 392), cv::Point(360, 400), 255, cv::FILLED);
  const auto result = detector.detect(frame_of(mask), {});
  ASSERT_EQ(result.detections.size(), 1u);
  EXPECT_GT(geometry::iou(result.detections[0].box, truth), 0.75);
}

TEST(PeopleDetector, CarsAndLeavesAreLeftOutAndCounted) {
  PeopleDetector detector = trained(30, 4);
  cv::Mat mask = cv::Mat::zeros(kSceneImage, CV_8UC1);
  cv::rectangle(mask, cv::Rect(100, 420, 240, 30), 255, cv::FILLED);  // a long, flat thing
  cv::rectangle(mask, cv::Rect(500, 300, 5, 5), 255, cv::FILLED);
  const auto result = detector.detect(frame_of(mask), {});
  EXPECT_TRUE(result.detections.empty());
  EXPECT_EQ(detector.counts().misfits, 1);
  EXPECT_EQ(detector.counts().noise, 1);
}

TEST(PeopleDetector, ReportsRegionsThemselvesWhileNoSizeIsKnown) {
  PeopleDetector detector(std::make_unique<Drawn>());
  cv::Mat mask = cv::Mat::zeros(kSceneImage, CV_8UC1);
  const Box truth = walker_at(300, 400);
  bodies::draw(mask, truth);
  const auto result = detector.detect(frame_of(mask), {});
  ASSERT_EQ(result.detections.size(), 1u);
  EXPECT_GT(geometry::iou(result.detections[0].box, truth), 0.8);
  EXPECT_LE(result.detections[0].score, 0.5);
}

TEST(PeopleDetector, DetectionPartsAreConsistent) {
  PeopleDetector detector = trained(30, 5);
  std::mt19937 random(6);
  for (int round = 0; round < 30; ++round) {
    cv::Mat mask = cv::Mat::zeros(kSceneImage, CV_8UC1);
    for (int i = 0; i < 12; ++i) {
      bodies::draw(mask, walker_at(bodies::uniform(random, -20, 780), bodies::uniform(random, 150, 620)),
                   bodies::uniform(random, 0, 1));
    }
    std::vector<Expected> expected;
    for (int i = 0; i < 6; ++i) {
      expected.push_back({walker_at(bodies::uniform(random, -200, 900), bodies::uniform(random, -100, 900))});
    }
    for (const Detection& one : detector.detect(frame_of(mask, round), expected).detections) {
      EXPECT_GT(one.score, 0);
      EXPECT_LE(one.score, 1);
      EXPECT_GT(one.area, 0);
      EXPECT_GE(one.outline.size(), 4u);
      EXPECT_GE(one.centre.x(), one.box.left - 0.5);
      EXPECT_GE(one.centre.y(), one.box.top - 0.5);
      EXPECT_LE(one.centre.x(), one.box.right() - 0.5);
      EXPECT_LE(one.centre.y(), one.box.bottom() - 0.5);
      EXPECT_GT(one.covariance.value()(0, 0), 0);
      EXPECT_GT(one.covariance.value()(1, 1), 0);
      EXPECT_GE(one.box.left, 0);
      EXPECT_GE(one.box.top, 0);
      EXPECT_LE(one.box.right(), kSceneImage.width);
      EXPECT_LE(one.box.bottom(), kSceneImage.height);
      EXPECT_FALSE(one.box.empty());
    }
  }
}

TEST(PeopleDetector, TheCentreIsThatOfThePixelsSeen) {
  PeopleDetector detector = trained(30, 8);
  cv::Mat mask = cv::Mat::zeros(kSceneImage, CV_8UC1);
  bodies::draw(mask, walker_at(400, 400));
  const auto result = detector.detect(frame_of(mask), {});
  ASSERT_EQ(result.detections.size(), 1u);
  const cv::Moments time_steps = cv::moments(mask, true);
  EXPECT_NEAR(result.detections[0].centre.x(), time_steps.m10 / time_steps.m00, 1.0);
  EXPECT_NEAR(result.detections[0].centre.y(), time_steps.m01 / time_steps.m00, 1.0);
  EXPECT_GT((result.detections[0].centre - result.detections[0].box.centre()).norm(), 0.5) << "a body is not a rectangle";
}

TEST(PeopleDetector, EmptyFullAndTinyPicturesDoNoHarm) {
  PeopleDetector detector = trained(30, 7);
  EXPECT_TRUE(detector.detect(frame_of(cv::Mat::zeros(kSceneImage, CV_8UC1)), {}).detections.empty());
  detector.detect(frame_of(cv::Mat(kSceneImage, CV_8UC1, cv::Scalar(255))), {});
  const std::array<Expected, 2> nowhere = {Expected{{-500, -500, 20, 50}}, Expected{{10, 10, 0, 0}}};
  detector.detect(frame_of(cv::Mat(kSceneImage, CV_8UC1, cv::Scalar(255))), nowhere);
  PeopleDetector fresh(std::make_unique<Drawn>());
  fresh.prime({});
  for (const int value : {0, 255}) {
    EXPECT_TRUE(fresh.detect(frame_of(cv::Mat(1, 1, CV_8UC1, cv::Scalar(value))), {}).detections.empty());
  }
}

}  // namespace
}  // namespace marey::detect::people
