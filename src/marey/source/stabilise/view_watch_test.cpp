#include "marey/source/stabilise/view_watch.h"

#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace marey::source::stabilise {
namespace {

constexpr int kWide = 400, kHigh = 300;

/// A large drawing with corners everywhere.
cv::Mat drawing(unsigned seed) {
  cv::Mat all(900, 1200, CV_8UC1, cv::Scalar(110));
  std::mt19937 random(seed);
  const auto draw = [&](int below) { return static_cast<int>(random() % static_cast<unsigned>(below)); };
  for (int i = 0; i < 1400; ++i) {
    const cv::Rect box(draw(1180), draw(880), 6 + draw(30), 6 + draw(30));
    cv::rectangle(all, box, cv::Scalar(40 + draw(170)), cv::FILLED);
  }
  cv::GaussianBlur(all, all, {}, 1.2);
  return all;
}

struct Detected {
  double x = 400, y = 300, zoom = 1;  // the drawing's place at the image's middle
  unsigned scene = 1;
};

/// Watches what a camera sees: `where` says it at each of `frames` frames.
ViewReport watched(int frames, double rate, const std::function<Detected(double)>& where,
                   const std::function<void(cv::Mat&, double)>& draw_into = {}) {
  const std::array<cv::Mat, 3> scenes{drawing(1), drawing(2), drawing(3)};
  std::mt19937 random(9);
  ViewWatch watch;
  for (int i = 0; i < frames; ++i) {
    const double time = i / rate;
    const Detected detected = where(time);
    const cv::Matx23d from(1 / detected.zoom, 0, detected.x - kWide / 2.0 / detected.zoom, 0, 1 / detected.zoom,
                           detected.y - kHigh / 2.0 / detected.zoom);
    cv::Mat image;
    cv::warpAffine(scenes.at(detected.scene - 1), image, from, {kWide, kHigh}, cv::INTER_LINEAR | cv::WARP_INVERSE_MAP,
                   cv::BORDER_REFLECT);
    if (draw_into) draw_into(image, time);
    cv::Mat noise(image.size(), CV_16SC1);
    cv::theRNG().state = 77 + static_cast<unsigned>(i);
    cv::randn(noise, 0, 3);
    cv::add(image, noise, image, cv::noArray(), CV_8U);
    watch.add({{}, i, timestamp_from_seconds(time), Image(image)});
  }
  return watch.report();
}

/// A person as tall as the image who crosses it in `way_s`.
void draw_giant(cv::Mat& image, double time, double way_s) {
  const int x = static_cast<int>(std::fmod(time, way_s) / way_s * (kWide + 300)) - 150;
  cv::ellipse(image, {x, kHigh / 2 + 40}, {75, 150}, 0, 0, 360, cv::Scalar(30), cv::FILLED);
  cv::circle(image, {x, 60}, 40, cv::Scalar(170), cv::FILLED);
}

TEST(ViewWatch, SaysNothingOfACameraThatStands) {
  for (const double rate : {2.0, 8.0, 25.0}) {
    SCOPED_TRACE(rate);
    const ViewReport report = watched(
        static_cast<int>(12 * rate), rate, [](double) { return Detected{}; },
        [](cv::Mat& image, double time) { draw_giant(image, time, 5); });
    EXPECT_TRUE(report.cuts.empty());
    EXPECT_FALSE(report.turn);
    EXPECT_LT(report.shake_px, 0.5);
    EXPECT_EQ(report.scrolling, 0);
    EXPECT_GT(report.images, 20);
  }
}

TEST(ViewWatch, SaysNothingOfSomebodyWhoLeavesAtOnceFromBeforeAnEmptyWall) {
  const ViewReport report = watched(
      100, 8, [](double) { return Detected{}; },
      [](cv::Mat& image, double time) {
        image(cv::Rect(0, 0, kWide, 200)).setTo(200);  // a wall, and little below it
        if (std::fmod(time, 4) < 2) cv::ellipse(image, {200, 180}, {140, 170}, 0, 0, 360, cv::Scalar(25), cv::FILLED);
      });
  EXPECT_TRUE(report.cuts.empty());
  EXPECT_FALSE(report.turn);
}

TEST(ViewWatch, DoesNotTakeLargePeopleBeforeALawnForCuts) {
  for (const double rate : {3.0, 5.0, 10.0, 25.0}) {
    SCOPED_TRACE(rate);
    const ViewReport report = watched(
        80, rate, [](double) { return Detected{}; },
        [](cv::Mat& image, double time) {
          image.convertTo(image, CV_8U, 0.03, 95);  // a lawn, with nothing to hold on to
          for (int i = 0; i < 4; ++i) {
            const int x = static_cast<int>(std::fmod(60 * (1 + 0.3 * i) * time + 140 * i, kWide + 160.0)) - 80;
            const int swing = static_cast<int>(25 * std::sin(6 * time + i));
            cv::rectangle(image, {x - 32, 10, 64, 140}, cv::Scalar(i % 2 == 0 ? 235 : 60), cv::FILLED);
            cv::rectangle(image, {x - 32, 150, 64, 40}, cv::Scalar(i % 2 == 0 ? 40 : 220), cv::FILLED);
            cv::line(image, {x - 12, 190}, {x - 12 + swing, 290}, cv::Scalar(210), 16);
            cv::line(image, {x + 12, 190}, {x + 12 - swing, 290}, cv::Scalar(30), 16);
          }
        });
    EXPECT_TRUE(report.cuts.empty());
  }
}

TEST(ViewWatch, SaysNothingWhereALampIsSwitchedOn) {
  const ViewReport report = watched(
      100, 10, [](double) { return Detected{}; },
      [](cv::Mat& image, double time) { image.convertTo(image, CV_8U, time > 5 ? 1.4 : 1, time > 5 ? 15 : 0); });
  EXPECT_TRUE(report.cuts.empty());
  EXPECT_FALSE(report.turn);
}

TEST(ViewWatch, TellsAPanAndHowFarItWent) {
  const ViewReport report = watched(200, 20, [](double time) { return Detected{.x = 400 + 40 * time}; });
  ASSERT_TRUE(report.turn);
  EXPECT_FALSE(report.turn->stays);
  EXPECT_NEAR(report.turn->fraction, 1, 0.15);
  EXPECT_NEAR(report.turn->zoom, 1, 0.03);
  EXPECT_TRUE(report.cuts.empty());
}

TEST(ViewWatch, TellsAZoom) {
  const ViewReport report = watched(200, 20, [](double time) { return Detected{.zoom = 1 + 0.05 * time}; });
  ASSERT_TRUE(report.turn);
  EXPECT_NEAR(report.turn->zoom, 1.5, 0.1);
  EXPECT_FALSE(report.turn->stays);
  EXPECT_TRUE(report.cuts.empty());
}

TEST(ViewWatch, TellsACameraThatWasTurnedOnceFromOneThatPans) {
  const ViewReport report = watched(300, 10, [](double time) { return Detected{.x = 400 + 50 * std::clamp(time - 20, 0.0, 1.0)}; });
  ASSERT_TRUE(report.turn);
  EXPECT_TRUE(report.turn->stays);
  EXPECT_NEAR(report.turn->fraction, 50.0 / kWide, 0.02);
  EXPECT_NEAR(report.turn->from_s, 20, 1.5);
}

TEST(ViewWatch, TellsAShakeInPixelsOfTheWholePicture) {
  const ViewReport report = watched(
      200, 20, [](double time) { return Detected{.x = 400 + 4 * std::sin(11 * time), .y = 300 + 3 * std::sin(17 * time)}; });
  EXPECT_FALSE(report.turn);
  EXPECT_NEAR(report.shake_px, std::sqrt(8 + 4.5), 1);
}

TEST(ViewWatch, TellsWhereAVideoIsCut) {
  const ViewReport report = watched(250, 25, [](double time) { return Detected{.scene = time < 3 ? 1U : time < 6.2 ? 2U : 3U}; });
  ASSERT_EQ(report.cuts.size(), 2U);
  EXPECT_NEAR(report.cuts[0], 3, 0.05);
  EXPECT_NEAR(report.cuts[1], 6.2, 0.05);
  EXPECT_FALSE(report.turn);
}

TEST(ViewWatch, TellsAScreenThatIsScrolledFromACamera) {
  const cv::Mat page = drawing(5);
  const ViewReport report = watched(
      200, 20, [](double) { return Detected{}; },
      [&](cv::Mat& image, double time) {
        const double scrolled = 30 * (std::floor(time) + std::min(1.0, 4 * (time - std::floor(time))));
        page({200, 100 + static_cast<int>(scrolled), 260, 240}).copyTo(image({100, 40, 260, 240}));
      });
  EXPECT_GT(report.scrolling, 0.1);
}

TEST(ViewWatch, BlackEmptyAndSmallPicturesDoNoHarm) {
  ViewWatch watch;
  EXPECT_FALSE(watch.report().turn);
  int index = 0;
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(40, 3), cv::Size(400, 300), cv::Size(400, 300), cv::Size(0, 0)}) {
    watch.add({{}, index, timestamp_from_seconds(index), Image(cv::Mat::zeros(size, CV_8UC1))});
    ++index;
  }
  EXPECT_TRUE(watch.report().cuts.empty());
}

}  // namespace
}  // namespace marey::source::stabilise
