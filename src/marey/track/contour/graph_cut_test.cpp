#include "marey/track/contour/graph_cut.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace marey::track::contour {
namespace {

ColourPatch even_patch(int wide, int high) {
  ColourPatch patch;
  patch.colour = cv::Mat(high, wide, CV_32FC3, cv::Scalar(90, 110, 115));
  patch.mask = cv::Mat::zeros(high, wide, CV_32FC1);
  return patch;
}

std::vector<cv::Mat> random_costs(int labels, int wide, int high, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> cost(0, 1);
  std::vector<cv::Mat> costs;
  for (int l = 0; l < labels; ++l) {
    costs.emplace_back(high, wide, CV_32FC1);
    for (int y = 0; y < high; ++y) {
      for (int x = 0; x < wide; ++x) costs.back().at<float>(y, x) = cost(random);
    }
  }
  return costs;
}

/// The least energy of all labellings.
double min_energy(const std::vector<cv::Mat>& costs, const NeighbourVotes& neighbours, float smoothness) {
  const int cells = static_cast<int>(costs.front().total()), labels = static_cast<int>(costs.size());
  double least = 1e9;
  const auto count = static_cast<long>(std::llround(std::pow(labels, cells)));
  for (long code = 0; code < count; ++code) {
    cv::Mat one(costs.front().size(), CV_8UC1);
    long left = code;
    for (int i = 0; i < cells; ++i, left /= labels)
      one.at<std::uint8_t>(i / one.cols, i % one.cols) = static_cast<std::uint8_t>(left % labels);
    least = std::min(least, label_energy(costs, neighbours, smoothness, one));
  }
  return least;
}

TEST(GraphCut, FindsTheLeastEnergyOfTwoLabels) {
  const ColourPatch patch = even_patch(4, 3);
  const NeighbourVotes neighbours(patch, patch.colour);
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const auto costs = random_costs(2, 4, 3, seed);
    for (const float smoothness : {0.0F, 2.0F, 8.0F}) {
      const cv::Mat labels = cut_labels(costs, neighbours, smoothness);
      EXPECT_NEAR(label_energy(costs, neighbours, smoothness, labels), min_energy(costs, neighbours, smoothness), 0.02);
    }
  }
}

TEST(GraphCut, ComesNearTheLeastEnergyOfThreeLabels) {
  const ColourPatch patch = even_patch(3, 3);
  const NeighbourVotes neighbours(patch, patch.colour);
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const auto costs = random_costs(3, 3, 3, seed);
    const cv::Mat labels = cut_labels(costs, neighbours, 4);
    EXPECT_LT(label_energy(costs, neighbours, 4, labels), min_energy(costs, neighbours, 4) + 0.3);
  }
}

TEST(GraphCut, EndsAtAnEdgeOfTheImage) {
  ColourPatch patch = even_patch(20, 10);
  patch.colour.colRange(12, 20).setTo(cv::Scalar(200, 110, 115));
  const cv::Mat ground(patch.size(), CV_32FC3, cv::Scalar(90, 110, 115));
  const NeighbourVotes neighbours(patch, ground);
  // Only the outermost columns know what they are.
  std::vector<cv::Mat> costs(2);
  for (cv::Mat& one : costs) one = cv::Mat::zeros(patch.size(), CV_32FC1);
  costs[1].col(0).setTo(20);
  costs[0].col(19).setTo(20);
  const cv::Mat labels = cut_labels(costs, neighbours, 8);
  EXPECT_EQ(cv::countNonZero(labels.colRange(0, 12)), 0);
  EXPECT_EQ(cv::countNonZero(labels.colRange(12, 20)), 80);
}

}  // namespace
}  // namespace marey::track::contour
