#include "marey/detect/markers/marker_detector.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/LU>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "marey/core/error.h"
#include "marey/detect/markers/marker_contrast.h"
#include "marey/detect/markers/marker_fit.h"

// The discs are drawn here, not by simulate/, which is a step of its own; bench/marker_accuracy measures with that one.
namespace marey::detect::markers {
namespace {

struct Spot {
  double x, y, radius;
  double level = 202;
  double blur = 0.55;
};

/// 12 + 190 · ½ erfc((d − R) / (√2 · blur)) over 8 × 8 points a pixel; spots hide those before them.
cv::Mat scene(cv::Size size, const std::vector<Spot>& spots, double noise, std::uint32_t seed, double background = 12,
              int depth = CV_8U, double scale = 1) {
  cv::Mat image(size, CV_32FC1, cv::Scalar(background));
  for (const Spot& spot : spots) {
    const int reach = static_cast<int>(spot.radius + 5 * spot.blur + 2);
    const cv::Rect box =
        cv::Rect(static_cast<int>(spot.x) - reach, static_cast<int>(spot.y) - reach, 2 * reach + 2, 2 * reach + 2) &
        cv::Rect({}, size);
    for (int y = box.y; y < box.br().y; ++y) {
      for (int x = box.x; x < box.br().x; ++x) {
        double fraction = 0;
        for (int k = 0; k < 64; ++k) {
          const double d = std::hypot(x - 0.4375 + k % 8 / 8.0 - spot.x, y - 0.4375 + k / 8 / 8.0 - spot.y);
          fraction += std::erfc((d - spot.radius) / (std::sqrt(2.0) * spot.blur)) / 128;
        }
        float& pixel = image.at<float>(y, x);
        pixel = static_cast<float>(pixel * (1 - fraction) + spot.level * fraction);
      }
    }
  }
  std::mt19937 random(seed);
  std::normal_distribution<float> grain(0, static_cast<float>(std::max(noise, 1e-3)));
  if (noise > 0) std::for_each(image.begin<float>(), image.end<float>(), [&](float& pixel) { pixel += grain(random); });
  cv::Mat result;
  image.convertTo(result, depth, scale);
  return result;
}

Frame frame_of(const cv::Mat& image, double time_s = 0) {
  Frame frame;
  frame.time = timestamp_from_seconds(time_s);
  frame.image = Image(image);
  return frame;
}

std::vector<Detection> find(const cv::Mat& image, const MarkerOptions& options = {}) {
  MarkerDetector detector(options);
  return detector.detect(frame_of(image), {}).detections;
}

double distance_to_nearest(const std::vector<Detection>& found, double x, double y) {
  double minimum = 1e9;
  for (const Detection& d : found) minimum = std::min(minimum, (d.centre - Vector<2>(x, y)).norm());
  return minimum;
}

struct Case {
  double radius, noise, must;
  double level = 202, background = 12;
  int depth = CV_8U;
  double scale = 1;
  bool dark = false;
};

/// Without it the bytes are printed, those between the members too, which were never set.
void PrintTo(const Case& each, std::ostream* out) {
  *out << "radius " << each.radius << " px, noise " << each.noise << ", level " << each.level << " on " << each.background;
}

class MarkerAccuracy : public testing::TestWithParam<Case> {};

TEST_P(MarkerAccuracy, RootMeanSquareAndBiasStayBelowTheirLimits) {
  const Case& c = GetParam();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> phase(-0.5, 0.5);
  MarkerOptions options;
  options.dark = c.dark;
  MarkerDetector detector(options);
  const int pitch = static_cast<int>(2 * c.radius) + 20, side = 8;
  double squares = 0, normalised = 0;
  Vector<2> low = Vector<2>::Zero(), high = Vector<2>::Zero();  // sum of errors in x and count, left and right in the pixel
  int count = 0;
  for (std::uint32_t k = 0; k < 5; ++k) {
    std::vector<Spot> spots;
    for (int i = 0; i < side * side; ++i) {
      spots.push_back(
          {i % side * pitch + pitch / 2 + phase(random), i / side * pitch + pitch / 2 + phase(random), c.radius, c.level});
    }
    const auto found =
        detector.detect(frame_of(scene({side * pitch, side * pitch}, spots, c.noise, k, c.background, c.depth, c.scale)), {});
    ASSERT_EQ(found.detections.size(), spots.size());
    for (std::size_t i = 0; i < spots.size(); ++i) {
      const auto nearest =
          std::min_element(found.detections.begin(), found.detections.end(), [&](const Detection& a, const Detection& b) {
            const Vector<2> location(spots[i].x, spots[i].y);
            return (a.centre - location).norm() < (b.centre - location).norm();
          });
      const Vector<2> error = nearest->centre - Vector<2>(spots[i].x, spots[i].y);
      squares += error.squaredNorm();
      normalised += error.dot(nearest->covariance->inverse() * error);
      (spots[i].x < std::round(spots[i].x) ? low : high) += Vector<2>(error.x(), 1);
      ++count;
    }
  }
  EXPECT_LE(std::sqrt(squares / (2 * count)), c.must);
  EXPECT_LE(std::abs(low.x() / low.y()), 0.010);
  EXPECT_LE(std::abs(high.x() / high.y()), 0.010);
  EXPECT_LT(normalised / count, 2.6) << "the covariance promises too much; 2 is right";
  EXPECT_GT(normalised / count, 0.5) << "the covariance promises too little; 2 is right";
}

INSTANTIATE_TEST_SUITE_P(Discs, MarkerAccuracy,
                         testing::Values(Case{1, 3, 0.050}, Case{2, 1, 0.012}, Case{2, 3, 0.030}, Case{3, 3, 0.020},
                                         Case{20, 3, 0.010}, Case{2, 3, 0.030, 12, 202, CV_8U, 1, true},
                                         Case{2, 3, 0.030, 202, 12, CV_16U, 16}, Case{2, 3, 0.030, 12, 202, CV_16U, 16, true}));

TEST(MarkerDetector, TouchingMarkersAreSplit) {
  for (const double radius : {2.0, 3.0, 5.0}) {
    for (const double apart : {1.2, 1.4, 1.6, 1.8, 2.0}) {
      for (int turn = 0; turn < 4; ++turn) {
        SCOPED_TRACE(testing::Message() << "radius " << radius << ", " << apart << " radii apart, turned " << turn);
        const double angle = 0.3 + turn * 0.8;
        const double dx = apart * radius / 2 * std::cos(angle), dy = apart * radius / 2 * std::sin(angle);
        // The blur fills the waist of two small ones that overlap far: only prior tracks distinguish them from one that moves.
        std::vector<Expected> expected;
        if (radius < 3 && apart < 1.6) {
          expected = {{Box::from_centre({30.2 - dx, 29.7 - dy}, 4, 4)}, {Box::from_centre({30.2 + dx, 29.7 + dy}, 4, 4)}};
        }
        const cv::Mat image = scene({60, 60}, {{30.2 - dx, 29.7 - dy, radius}, {30.2 + dx, 29.7 + dy, radius}}, 3, 7);
        MarkerDetector detector;
        const auto found = detector.detect(frame_of(image), expected).detections;
        ASSERT_EQ(found.size(), 2u);
        EXPECT_LT(distance_to_nearest(found, 30.2 - dx, 29.7 - dy), 0.15);
        EXPECT_LT(distance_to_nearest(found, 30.2 + dx, 29.7 + dy), 0.15);
      }
    }
  }
}

TEST(MarkerDetector, AMarkerDrawnOutByItsMotionIsNotSplit) {
  for (const double length : {2.0, 4.0, 8.0}) {
    cv::Mat sum = cv::Mat::zeros(60, 60, CV_32FC1);
    for (int i = 0; i <= 40; ++i) {
      const double along = length * (i / 40.0 - 0.5);
      cv::Mat part;
      scene({60, 60}, {{30.2 + 0.8 * along, 29.7 + 0.6 * along, 3}}, 0, 0, 12, CV_16U, 100).convertTo(part, CV_32F, 0.01 / 41);
      sum += part;
    }
    cv::Mat image;
    cv::Mat grain(sum.size(), CV_32FC1);
    cv::RNG(3).fill(grain, cv::RNG::NORMAL, 0, 2);
    sum += grain;
    sum.convertTo(image, CV_8U);
    const auto found = find(image);
    ASSERT_EQ(found.size(), 1u) << length;
    EXPECT_LT(distance_to_nearest(found, 30.2, 29.7), 0.1) << length;
  }
}

TEST(MarkerDetector, ASaturatedMarkerAndACloseNeighbourKeepTheirPlaces) {
  const auto found = find(scene({80, 60}, {{20.3, 20.4, 3, 600}, {50.3, 30.2, 3}, {59.1, 30.8, 3}}, 2, 1));
  ASSERT_EQ(found.size(), 3u);
  EXPECT_LT(distance_to_nearest(found, 20.3, 20.4), 0.05);
  EXPECT_LT(distance_to_nearest(found, 50.3, 30.2), 0.05);
  EXPECT_LT(distance_to_nearest(found, 59.1, 30.8), 0.05);
}

TEST(MarkerDetector, ABackgroundThatIsBrightOnOneSideHidesNothing) {
  cv::Mat image = scene({256, 192}, {{40.3, 60.2, 3, 200}, {220.6, 100.4, 3, 250}}, 2, 1, 0);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      auto& pixel = image.at<std::uint8_t>(y, x);
      pixel = std::max<std::uint8_t>(pixel, static_cast<std::uint8_t>(10 + x / 2));
    }
  }
  const auto found = find(image);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_LT(distance_to_nearest(found, 40.3, 60.2), 0.1);
  EXPECT_LT(distance_to_nearest(found, 220.6, 100.4), 0.1);
}

/// What a camera makes of it: noise, rounded.
cv::Mat with_noise(const cv::Mat& clean, double sigma, std::uint64_t seed) {
  cv::Mat grain(clean.size(), CV_32FC1), sum;
  cv::RNG(seed).fill(grain, cv::RNG::NORMAL, 0, sigma);
  clean.convertTo(sum, CV_32F);
  sum += grain;
  cv::Mat image;
  sum.convertTo(image, CV_8U);
  return image;
}

TEST(MarkerDetector, AWideGreyBarIsNoMarkerAndHidesNone) {
  const std::vector<Spot> spots{{60.3, 80.2, 3}, {330.6, 240.4, 3}, {500.2, 400.9, 4}, {198.7, 300.2, 3}};
  cv::Mat clean = scene({640, 480}, spots, 0, 0, 18);
  for (const double bar : {35.0, 60.0, 90.0}) {
    cv::Mat image = clean.clone();
    image(cv::Rect(210, 0, 213, 480)) = cv::max(image(cv::Rect(210, 0, 213, 480)), bar);
    for (const double turn : {0.0, 17.0}) {
      cv::Mat rotated;
      cv::warpAffine(image, rotated, cv::getRotationMatrix2D({320, 240}, turn, 1), image.size(), cv::INTER_LINEAR,
                     cv::BORDER_REPLICATE);
      SCOPED_TRACE(testing::Message() << "bar " << bar << ", turned " << turn);
      EXPECT_EQ(find(with_noise(rotated, 4, 3)).size(), spots.size());
    }
  }
}

TEST(MarkerDetector, SpecksDoNotSayWhatAMarkerIs) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> x(5, 1019), y(5, 699), level(25, 50);
  std::vector<Spot> spots;
  for (int i = 0; i < 90; ++i) spots.push_back({x(random), y(random), 0.9, level(random)});
  // Large, saturated, and two pairs that touch.
  const std::vector<Spot> markers{{200.3, 200.4, 5, 900}, {400.1, 300.7, 5, 250}, {600.2, 150.5, 5, 250},
                                  {608.9, 153.0, 5, 250}, {800.5, 500.2, 5, 250}, {800.9, 509.3, 5, 250}};
  spots.insert(spots.end(), markers.begin(), markers.end());
  MarkerDetector detector;
  const auto found = detector.detect(frame_of(scene({1024, 704}, spots, 2, 4)), {}).detections;
  EXPECT_EQ(found.size(), markers.size());
  for (const Spot& marker : markers) EXPECT_LT(distance_to_nearest(found, marker.x, marker.y), 0.3) << marker.x;
  EXPECT_EQ(detector.counts().unlike, 0);
}

TEST(MarkerDetector, MarkersInMotionBesideSpecksAreKept) {
  cv::Mat sum = cv::Mat::zeros(300, 400, CV_32FC1);
  for (int i = 0; i <= 40; ++i) {
    const double along = 12 * (i / 40.0 - 0.5);
    cv::Mat part;
    scene({400, 300}, {{100.2 + along, 80.7, 4}, {300.6 + along, 200.2, 4}, {50, 200, 0.9, 45}, {200, 50, 0.9, 45}}, 0, 0, 12,
          CV_16U, 100)
        .convertTo(part, CV_32F, 0.01 / 41);
    sum += part;
  }
  const auto found = find(with_noise(sum, 2, 5));
  ASSERT_EQ(found.size(), 2u);
  EXPECT_LT(distance_to_nearest(found, 100.2, 80.7), 0.2);
  EXPECT_LT(distance_to_nearest(found, 300.6, 200.2), 0.2);
}

TEST(MarkerDetector, ALampWithItsHaloIsLeftOutAndSaid) {
  cv::Mat clean;
  scene({400, 300}, {{100.2, 80.7, 4, 230}, {300.6, 200.2, 4, 230}, {60.4, 220.3, 4, 230}}, 0, 0, 12).convertTo(clean, CV_32F);
  for (int y = 0; y < 300; ++y) {
    for (int x = 0; x < 400; ++x) {
      const double away = std::hypot(x - 200.0, y - 120.0) - 18;
      clean.at<float>(y, x) += static_cast<float>(away > 0 ? 110 * std::exp(-away / 25) : 400);
    }
  }
  MarkerDetector detector;
  const auto found = detector.detect(frame_of(with_noise(clean, 2, 6)), {}).detections;
  EXPECT_EQ(found.size(), 3u);
  EXPECT_GT(distance_to_nearest(found, 200, 120), 20);
  EXPECT_EQ(detector.counts().unlike, 1);
  ASSERT_EQ(warnings(detector.counts()).size(), 1u);
  EXPECT_NE(warnings(detector.counts())[0].find("unlike the markers"), std::string::npos);
}

TEST(MarkerDetector, MarkersThatBecomeDarkerAreFoundAgain) {
  MarkerDetector detector;
  for (int i = 0; i < 20; ++i)
    EXPECT_EQ(detector.detect(frame_of(scene({320, 240}, {{100, 100, 3, 240}}, 2, i)), {}).detections.size(), 1u);
  std::size_t found = 0;
  for (std::uint32_t i = 0; i < 90; ++i)
    found += detector.detect(frame_of(scene({320, 240}, {{100, 100, 3, 50}}, 2, i)), {}).detections.size();
  EXPECT_GT(found, 20u);
}

TEST(MarkerDetector, NoiseAloneAndASaturatedFrameHoldNoMarker) {
  for (const double noise : {0.0, 1.0, 5.0, 20.0}) EXPECT_TRUE(find(scene({640, 480}, {}, noise, 9, 60)).empty()) << noise;
  MarkerDetector detector;
  const Frame dark = frame_of(scene({640, 480}, {{100, 100, 3}}, 2, 1));
  EXPECT_EQ(detector.detect(dark, {}).detections.size(), 1u);
  EXPECT_TRUE(detector.detect(frame_of(cv::Mat(480, 640, CV_8UC1, cv::Scalar(255))), {}).detections.empty());
  EXPECT_EQ(detector.detect(dark, {}).detections.size(), 1u);
}

TEST(MarkerDetector, GlareIsBoundedAndToldAndExpectedMarkersStay) {
  std::vector<Spot> spots{{1100.3, 900.2, 1}};  // the smallest
  for (int i = 0; i < 5000; ++i) spots.push_back({8.0 + i % 100 * 12, 8.0 + i / 100 * 12, 2});
  MarkerOptions options;
  options.max_markers = 2000;
  MarkerDetector detector(options);
  const std::vector<Expected> expected{{Box::from_centre({1100, 900}, 20, 20)}};
  const auto found = detector.detect(frame_of(scene({1280, 1024}, spots, 2, 1)), expected).detections;
  EXPECT_EQ(found.size(), 2000u);
  EXPECT_LT(distance_to_nearest(found, 1100.3, 900.2), 0.1);
  EXPECT_EQ(detector.counts().over_limit, 3001);
  ASSERT_EQ(warnings(detector.counts()).size(), 1u);
}

TEST(MarkerDetector, LimitsOnAreaAndRoundnessAndAFixedThreshold) {
  cv::Mat image = scene({200, 100}, {{20, 20, 1}, {60, 20, 4}, {120, 50, 15}}, 1, 1);
  image(cv::Rect(30, 80, 60, 2)).setTo(220);  // a bar
  MarkerOptions options;
  options.min_area = 20;
  options.max_area = 300;
  MarkerDetector detector(options);
  const auto found = detector.detect(frame_of(image), {}).detections;
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].area, M_PI * 16, 2);
  EXPECT_EQ(detector.counts().too_small, 1);
  EXPECT_EQ(detector.counts().too_large, 1);
  EXPECT_EQ(detector.counts().not_round, 1);
  options = {};
  options.threshold = 230;
  EXPECT_TRUE(find(image, options).empty());
}

TEST(MarkerDetector, DarkMarkersOnAWhitePlateBeforeBlackAreFoundByAFixedThreshold) {
  cv::Mat image = scene({128, 128}, {{70.3, 60.2, 2, 20}, {75.6, 30.4, 2, 20}}, 2, 1, 200);
  image(cv::Rect(0, 0, 60, 128)).setTo(15);
  image(cv::Rect(90, 0, 38, 128)).setTo(15);
  MarkerOptions options;
  options.dark = true;
  options.threshold = 110;
  options.max_area = 500;
  for (const int depth : {CV_8U, CV_16U}) {
    cv::Mat deep;
    image.convertTo(deep, depth);
    const auto found = find(deep, options);
    ASSERT_EQ(found.size(), 2u);
    EXPECT_LT(distance_to_nearest(found, 70.3, 60.2), 0.1);
    EXPECT_LT(distance_to_nearest(found, 75.6, 30.4), 0.1);
  }
}

/// Single lines of pixels along the borders: the address sanitizer sees reads beyond them.
TEST(MarkerDetector, ReadsNothingOutsideThePicture) {
  for (const cv::Rect& line : {cv::Rect(30, 99, 4, 1), cv::Rect(60, 0, 4, 1), cv::Rect(0, 30, 1, 4), cv::Rect(99, 60, 1, 4)}) {
    cv::Mat image = scene({100, 100}, {}, 2, 3);
    image(line).setTo(200);
    MarkerBlob blob{};
    blob.box = line;
    blob.area = line.area();
    const MarkerContrast contrast = contrast_of(image, blob, false, 12);
    EXPECT_NEAR(contrast.around, 12, 2);
    EXPECT_NEAR(contrast.height, 188, 8);
  }
}

TEST(MarkerDetector, MasksLeaveOutWhatTheyCover) {
  const cv::Mat image = scene({100, 60}, {{20.2, 20, 3}, {70.4, 30, 3}}, 1, 1);
  MarkerOptions options;
  options.mask = cv::Mat::zeros(60, 100, CV_8U);
  options.mask(cv::Rect(0, 0, 40, 60)).setTo(255);
  const auto found = find(image, options);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_LT(distance_to_nearest(found, 70.4, 30), 0.1);
  options.mask = cv::Mat::zeros(10, 10, CV_8U);
  EXPECT_THROW(find(image, options), Error);
}

TEST(MarkerDetector, ChangedWhileItLooksItLeavesOutPartsAndWhatIsFaint) {
  const cv::Mat image = scene({100, 60}, {{20.2, 20, 3}, {70.4, 30, 3, 90}}, 1, 1);
  MarkerDetector detector;
  EXPECT_EQ(detector.detect(frame_of(image), {}).detections.size(), 2u);
  MarkerOptions options;
  options.masked = {{-5, -5, 45, 80}};  // as far as it lies in the image
  detector.change(options);
  const auto unmasked = detector.detect(frame_of(image, 1), {}).detections;
  ASSERT_EQ(unmasked.size(), 1u);
  EXPECT_LT(distance_to_nearest(unmasked, 70.4, 30), 0.1);
  options.threshold = 120;
  detector.change(options);
  EXPECT_TRUE(detector.detect(frame_of(image, 2), {}).detections.empty());
  detector.change({});
  EXPECT_EQ(detector.detect(frame_of(image, 3), {}).detections.size(), 2u);
  EXPECT_EQ(detector.counts().frames, 4);
}

TEST(MarkerDetector, TheAutomaticMaskLearnsLampsAndKeepsWhatMoves) {
  MarkerOptions options;
  options.auto_mask_s = 1;
  MarkerDetector detector(options);
  for (int i = 0; i < 60; ++i) {
    const double x = 20 + 2.0 * i;
    const auto found = detector.detect(frame_of(scene({200, 80}, {{100, 60, 5}, {x, 20, 3}}, 1, i), i / 30.0), {}).detections;
    ASSERT_EQ(found.size(), i <= 30 ? 2u : 1u) << i;
    EXPECT_LT(distance_to_nearest(found, x, 20), 0.1);
    EXPECT_EQ(detector.learned_parts().has_value(), i > 30);
  }
  EXPECT_GT(detector.counts().masked_fraction, 0.004);
  ASSERT_EQ(detector.learned_parts()->size(), 1u);
  const cv::Rect lamp = detector.learned_parts()->front();
  EXPECT_EQ(lamp & cv::Rect(95, 55, 10, 10), cv::Rect(95, 55, 10, 10));
  EXPECT_LT(lamp.area(), 300);
}

TEST(MarkerDetector, ColouredMarkersAreToldByTheirHue) {
  cv::Mat bgr(120, 200, CV_8UC3, cv::Scalar(90, 90, 90));
  cv::circle(bgr, {40 * 16, 60 * 16}, 8 * 16, cv::Scalar(40, 200, 40), cv::FILLED, cv::LINE_AA, 4);   // green
  cv::circle(bgr, {100 * 16, 60 * 16}, 8 * 16, cv::Scalar(200, 60, 40), cv::FILLED, cv::LINE_AA, 4);  // blue
  cv::circle(bgr, {160 * 16, 60 * 16}, 8 * 16, cv::Scalar(40, 40, 220), cv::FILLED, cv::LINE_AA, 4);  // red
  for (const auto& [hue, x] : {std::pair(120.0, 40.0), std::pair(232.0, 100.0), std::pair(0.0, 160.0)}) {
    MarkerOptions options;
    options.colour = MarkerColour{hue, 20, 0.2};
    MarkerDetector detector(options);
    Frame frame;
    frame.image = Image::from_bgr(bgr);
    const auto found = detector.detect(frame, {}).detections;
    ASSERT_EQ(found.size(), 1u) << hue;
    EXPECT_LT(distance_to_nearest(found, x, 60), 0.6) << hue;
  }
  MarkerOptions options;
  options.colour = MarkerColour{};
  EXPECT_THROW(find(cv::Mat::zeros(20, 20, CV_8U), options), Error);
}

TEST(MarkerColour, ReadsHueAndTolerance) {
  EXPECT_EQ(parse_marker_colour("120+-15").hue_deg, 120);
  EXPECT_EQ(parse_marker_colour("200.5\u00b17.5").hue_deg, 200.5);
  EXPECT_EQ(parse_marker_colour("200.5\u00b17.5").tolerance_deg, 7.5);
  EXPECT_EQ(parse_marker_colour("90").tolerance_deg, 15);
  for (const char* wrong : {"", "green", "120+-", "+-15", "120+-0", "400", "-5", "120+-90", "120 15", "nan", "120+-1e999"}) {
    EXPECT_THROW(parse_marker_colour(wrong), Error) << wrong;
  }
}

}  // namespace
}  // namespace marey::detect::markers
