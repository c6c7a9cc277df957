// What pixels say, by made images: that shaded ground is ground, that labels end at edges.
#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "marey/track/contour/ground_likelihood.h"
#include "marey/track/contour/neighbour_votes.h"

namespace marey::track::contour {
namespace {

const cv::Scalar kGrass(110, 105, 115), kScarlet(84, 100, 200);

ColourPatch patch_of(const cv::Size& size, const cv::Scalar& colour) {
  ColourPatch patch;
  patch.colour = cv::Mat(size, CV_32FC3, colour);
  patch.mask = cv::Mat::ones(size, CV_32FC1);
  return patch;
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
}  // namespace marey::track::contour
