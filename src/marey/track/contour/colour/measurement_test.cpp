// What pixels say, by made images: where chroma lies beside its luma, that shaded ground is ground, that labels end at edges.
#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "marey/track/contour/colour/chroma_shift.h"
#include "marey/track/contour/colour/ground_likelihood.h"
#include "marey/track/contour/colour/neighbour_votes.h"

namespace marey::track::contour::colour {
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

ColourPatch patch_of(const cv::Size& size, const cv::Scalar& colour) {
  ColourPatch patch;
  patch.colour = cv::Mat(size, CV_32FC3, colour);
  patch.mask = cv::Mat::ones(size, CV_32FC1);
  return patch;
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

TEST(GroundLikelihood, ShadeIsGroundAndShirtIsNot) {
  const cv::Size size(9, 9);
  const cv::Mat ground(size, CV_32FC3, kGrass);
  const auto at_middle = [&](const cv::Scalar& colour) {
    return ground_likelihood(patch_of(size, colour), ground).at<float>(4, 4);
  };
  const cv::Scalar shade(16 + 0.6 * (kGrass[0] - 16), 128 + 0.6 * (kGrass[1] - 128), 128 + 0.6 * (kGrass[2] - 128));
  EXPECT_GT(at_middle(kGrass), at_middle(shade));
  EXPECT_GT(at_middle(shade), 20 * at_middle(kScarlet));
  EXPECT_GT(at_middle(shade), 20 * at_middle({200, 128, 128}));
}

TEST(GroundLikelihood, ColourOnASlopeSaysLess) {
  // Reddish ground beside a red shirt, against the same colour where nothing red is near.
  const cv::Size size(9, 9);
  const cv::Mat ground(size, CV_32FC3, kGrass);
  const cv::Scalar reddish(kGrass[0], kGrass[1], kGrass[2] + 25);
  ColourPatch alone = patch_of(size, reddish), beside = patch_of(size, reddish);
  for (int x = 0; x < size.width; ++x) {
    for (int y = 0; y < size.height; ++y) beside.colour.at<cv::Vec3f>(y, x)[2] += static_cast<float>(18 * (x - 4));
  }
  EXPECT_GT(ground_likelihood(beside, ground).at<float>(4, 4), 2 * ground_likelihood(alone, ground).at<float>(4, 4));
}

TEST(NeighbourVotes, EndAtEdgesThatTheSceneDoesNotHave) {
  const cv::Size size(10, 7);
  ColourPatch patch = patch_of(size, kGrass);
  patch.colour(cv::Rect(5, 0, 5, 7)).setTo(cv::Scalar(170, 105, 115));
  cv::Mat left = cv::Mat::zeros(size, CV_32FC1);
  left(cv::Rect(0, 0, 5, 7)).setTo(1);
  const cv::Mat lawn(size, CV_32FC3, kGrass);
  EXPECT_LT(NeighbourVotes(patch, lawn).of(left).at<float>(3, 5), 0.02F);
  // A white line of the pitch does not end a body.
  EXPECT_GT(NeighbourVotes(patch, patch.colour).of(left).at<float>(3, 5), 0.2F);
  EXPECT_NEAR(NeighbourVotes(patch, lawn).of(left).at<float>(3, 2), 1, 1e-5);
}

}  // namespace
}  // namespace marey::track::contour::colour
