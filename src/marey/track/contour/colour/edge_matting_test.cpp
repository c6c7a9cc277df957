#include "marey/track/contour/colour/edge_matting.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "marey/geometry/bspline.h"
#include "marey/track/contour/colour/scene_image.h"

namespace marey::track::contour::colour {
namespace {

constexpr int kSize = 80;

/// A disc before a lawn, each pixel mixed by how much of it the disc covers.
Image image_of_disc(const Vector<2>& centre, double radius, bool degraded, int luma) {
  cv::Mat covered = cv::Mat::zeros(8 * kSize, 8 * kSize, CV_8UC1);
  for (int y = 0; y < covered.rows; ++y) {
    for (int x = 0; x < covered.cols; ++x) {
      const Vector<2> at((x + 0.5) / 8 - 0.5, (y + 0.5) / 8 - 0.5);
      covered.at<std::uint8_t>(y, x) = (at - centre).norm() < radius ? 255 : 0;
    }
  }
  const auto plane = [&](cv::Size size, double inside, double outside) {
    cv::Mat fraction, levels;
    cv::resize(covered, fraction, size, 0, 0, cv::INTER_AREA);
    fraction.convertTo(levels, CV_8UC1, (inside - outside) / 255, outside);
    return levels;
  };
  cv::Mat y = plane({kSize, kSize}, luma, 90), cb = plane({kSize / 2, kSize / 2}, 120, 105),
          cr = plane({kSize / 2, kSize / 2}, 150, 118);
  if (degraded) {  // a lens, sharpening, chroma that is filtered harder
    cv::Mat wide;
    cv::GaussianBlur(y, y, {}, 0.8);
    cv::GaussianBlur(y, wide, {}, 2);
    cv::addWeighted(y, 1.45, wide, -0.45, 0, y);
    for (cv::Mat* chroma : {&cb, &cr}) cv::GaussianBlur(*chroma, *chroma, {}, 1.2);
  }
  return {y, cb, cr, Image::Range::limited};
}

/// px by which the curve of the matted edge is wider than the disc, given a share that is `wider` px too wide.
double bias_of(const Vector<2>& centre, double radius, bool degraded, int luma, double wider) {
  const Image image = image_of_disc(centre, radius, degraded, luma);
  const cv::Mat mask = cv::Mat::zeros(kSize, kSize, CV_8UC1);
  const ColourPatch patch = cut_patch(image, mask, {0, 0, kSize, kSize}, 1);
  cv::Mat fraction = cv::Mat::zeros(patch.size(), CV_32FC1);
  for (int y = 0; y < fraction.rows; ++y) {
    for (int x = 0; x < fraction.cols; ++x)
      fraction.at<float>(y, x) = (patch.pixel(Vector<2>(x, y)) - centre).norm() < radius + wider ? 1.0F : 0.0F;
  }
  const cv::Mat ground(patch.size(), CV_32FC3, cv::Scalar(90, 105, 118));
  const auto curve = half_level_curve(matted_edge(patch, fraction, {}, ground, 60), patch);
  if (curve.empty()) return 1e9;
  return std::sqrt(geometry::polygon_area(curve) / 3.14159265358979) - radius;
}

TEST(EdgeMatting, FindsTheEdgeOfADiscThatASilhouetteMisses) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<> location(-0.5, 0.5);
  for (const int luma : {30, 190}) {
    for (const double radius : {8.0, 14.0, 25.0}) {
      for (const double wider : {-1.0, 0.0, 1.0}) {
        const Vector<2> centre(kSize / 2 + location(random), kSize / 2 + location(random));
        const double sharp = bias_of(centre, radius, false, luma, wider);
        EXPECT_NEAR(sharp, 0, 0.1) << luma << ' ' << radius << ' ' << wider;
        const double degraded = bias_of(centre, radius, true, luma, wider);
        EXPECT_NEAR(degraded, 0, 0.35) << luma << ' ' << radius << ' ' << wider;
      }
    }
  }
}

TEST(EdgeMatting, KeepsTheShareWhereAnotherBodyIs) {
  const Image image = image_of_disc({40, 40}, 15, false, 190);
  const ColourPatch patch = cut_patch(image, cv::Mat::zeros(kSize, kSize, CV_8UC1), {0, 0, kSize, kSize}, 1);
  const cv::Mat ground(patch.size(), CV_32FC3, cv::Scalar(90, 105, 118));
  cv::Mat fraction = cv::Mat::zeros(patch.size(), CV_32FC1);
  cv::circle(fraction, {40, 40}, 16, cv::Scalar(0.8), cv::FILLED);
  const cv::Mat blocked = cv::Mat::ones(patch.size(), CV_32FC1);
  const cv::Mat result = matted_edge(patch, fraction, blocked, ground, 60);
  EXPECT_FLOAT_EQ(result.at<float>(40, 56), 0.8F);  // along the edge
  EXPECT_FLOAT_EQ(result.at<float>(40, 40), 1);     // inside
  EXPECT_FLOAT_EQ(result.at<float>(40, 70), 0);     // outside
}

TEST(EdgeMatting, KeepsTheShareWithoutContrast) {
  const Image image = image_of_disc({40, 40}, 15, false, 92);
  ColourPatch patch = cut_patch(image, cv::Mat::zeros(kSize, kSize, CV_8UC1), {0, 0, kSize, kSize}, 1);
  cv::Mat fraction = cv::Mat::zeros(patch.size(), CV_32FC1);
  cv::circle(fraction, {40, 40}, 16, cv::Scalar(0.8), cv::FILLED);
  const cv::Mat result = matted_edge(patch, fraction, {}, patch.colour, 60);
  EXPECT_FLOAT_EQ(result.at<float>(40, 56), 0.8F);
}

TEST(SceneImage, IsWhatNobodyCovers) {
  std::mt19937_64 random(5);
  std::uniform_int_distribution<> level(40, 200), noise(-2, 2);
  cv::Mat scene(48, 64, CV_8UC1), cb(24, 32, CV_8UC1), cr(24, 32, CV_8UC1);
  for (cv::Mat* plane : {&scene, &cb, &cr}) {
    for (int y = 0; y < plane->rows; ++y) {
      for (int x = 0; x < plane->cols; ++x) plane->at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(level(random));
    }
  }
  SceneImage learned;
  EXPECT_FALSE(learned.has({64, 48}));
  for (int frame = 0; frame < 120; ++frame) {
    cv::Mat luma = scene.clone(), mask = cv::Mat::zeros(scene.size(), CV_8UC1);
    for (int y = 0; y < luma.rows; ++y) {
      for (int x = 0; x < luma.cols; ++x)
        luma.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(scene.at<std::uint8_t>(y, x) + noise(random));
    }
    for (const cv::Rect& body : {cv::Rect(frame / 4, 10, 8, 20), cv::Rect(50, 30, 6, 10)}) {
      luma(body).setTo(250);
      mask(body).setTo(255);
    }
    learned.observe(Image(luma, cb, cr, Image::Range::limited), mask);
  }
  ASSERT_TRUE(learned.has({64, 48}));
  const cv::Rect all(0, 0, 64, 48);
  const cv::Mat known = learned.known(all), luma = learned.luma(all), chroma = learned.chroma(1, {0, 0, 32, 24});
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) {
      const bool hidden = cv::Rect(50, 30, 6, 10).contains({x, y});
      ASSERT_EQ(known.at<float>(y, x), hidden ? 0 : 1) << x << ' ' << y;
      if (hidden) continue;
      EXPECT_NEAR(luma.at<float>(y, x), scene.at<std::uint8_t>(y, x), 2) << x << ' ' << y;
      if (x % 2 != 0 || y % 2 != 0) continue;
      EXPECT_NEAR(chroma.at<float>(y / 2, x / 2), cr.at<std::uint8_t>(y / 2, x / 2), 1) << x << ' ' << y;
    }
  }
}

TEST(SceneImage, LearnsNothingWithinTargets) {
  // A person stands before a dark scene, and the foreground has lost them.
  const cv::Mat half(24, 32, CV_8UC1, cv::Scalar(128)), nothing = cv::Mat::zeros(48, 64, CV_8UC1);
  const cv::Rect body(20, 10, 8, 30);
  const Box box{18, 8, 12, 34};
  SceneImage learned;
  for (int frame = 0; frame < 120; ++frame) {
    cv::Mat luma(48, 64, CV_8UC1, cv::Scalar(60));
    const bool is_there = frame >= 20 && frame < 110;
    if (is_there) luma(body).setTo(220);
    learned.observe(Image(luma, half, half, Image::Range::limited), nothing, std::span(&box, is_there ? 1 : 0));
    EXPECT_NEAR(cv::mean(learned.luma(body))[0], 60, 1) << frame;
  }
}

}  // namespace
}  // namespace marey::track::contour::colour
