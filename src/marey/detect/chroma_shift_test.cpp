// Images made with a known displacement and smear of chroma.
#include "marey/detect/chroma_shift.h"

#include <array>
#include <random>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace marey::detect {
namespace {

const cv::Scalar kGrass(110, 105, 115), kScarlet(84, 100, 200);

/// A red post before a lawn in 4:2:0, its chroma displaced and smeared; all in px of luma.
Image post(double shift, double smear) {
  const cv::Size size(160, 120);
  std::array<cv::Mat, 3> planes;
  std::mt19937 dice(5);
  std::normal_distribution<float> noise(0, 1.5F);
  for (int c = 0; c < 3; ++c) {
    cv::Mat plane(size, CV_32FC1, cv::Scalar(kGrass[c]));
    plane(cv::Rect(70, 20, 18, 80)).setTo(kScarlet[c]);
    cv::GaussianBlur(plane, plane, {}, c == 0 ? 0.6 : 0.6 + smear);
    if (c > 0) {
      cv::warpAffine(plane, plane, cv::Matx23d(1, 0, shift, 0, 1, 0), size, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
      cv::resize(plane, plane, size / 2, 0, 0, cv::INTER_AREA);
    }
    for (auto level = plane.begin<float>(); level != plane.end<float>(); ++level) *level += noise(dice);
    plane.convertTo(planes[static_cast<std::size_t>(c)], CV_8U);
  }
  return {planes[0], planes[1], planes[2], Image::Range::limited};
}

ChromaShift shift_of(double shift, double smear) {
  cv::Mat mask = cv::Mat::zeros(120, 160, CV_8UC1);
  mask(cv::Rect(60, 16, 38, 88)).setTo(255);
  ChromaShift measured;
  for (int i = 0; i < 8; ++i) measured.observe(post(shift, smear), mask);
  return measured;
}

TEST(ChromaShift, MeasuresTheDisplacementOfChroma) {
  for (const double shift : {-2.0, -1.0, 0.0, 1.0, 2.0}) EXPECT_NEAR(shift_of(shift, 0.8).px(), shift, 0.35) << shift;
}

TEST(ChromaShift, MeasuresSmear) {
  EXPECT_GT(shift_of(0, 2.2).smear(), shift_of(0, 0).smear() + 0.8);
}

TEST(ChromaShift, IsZeroWithoutForeground) {
  EXPECT_EQ(ChromaShift().px(), 0);
  ChromaShift empty;
  empty.observe(post(2, 0), cv::Mat::zeros(120, 160, CV_8UC1));
  EXPECT_EQ(empty.px(), 0);
  EXPECT_EQ(empty.smear(), 0);
}

}  // namespace
}  // namespace marey::detect
