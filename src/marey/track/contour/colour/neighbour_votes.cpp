#include "marey/track/contour/colour/neighbour_votes.h"

#include <algorithm>
#include <cmath>

namespace marey::track::contour::colour {
namespace {

constexpr float kEdge = 12;             // levels between neighbours, from which on they say little of each other; unswept
constexpr float kEdgeChroma = 0.1F;     // weight of squared differences of chroma, whose edges are blurred; unswept
constexpr float kSceneEdge = 5;         // levels between neighbours in the scene, from which on an edge is the scene's; unswept
constexpr float kOneOfNine = 1.0F / 9;  // of one cell among nine; by definition

float step_of(const cv::Vec3f& a, const cv::Vec3f& b) {
  const cv::Vec3f step = a - b;
  return step[0] * step[0] + kEdgeChroma * (step[1] * step[1] + step[2] * step[2]);
}

}  // namespace

NeighbourVotes::NeighbourVotes(const ColourPatch& patch, const cv::Mat& ground) {
  const cv::Size size = patch.size();
  for (std::size_t i = 0; i < kToNeighbour.size(); ++i) {
    const auto [right, below] = kToNeighbour[i];
    weights_[i] = cv::Mat::zeros(size, CV_32FC1);
    for (int y = 0; y + below < size.height; ++y) {
      const auto* here = patch.colour.ptr<cv::Vec3f>(y);
      const auto* there = patch.colour.ptr<cv::Vec3f>(y + below);
      const auto* scene_here = ground.ptr<cv::Vec3f>(y);
      const auto* scene_there = ground.ptr<cv::Vec3f>(y + below);
      auto* weight = weights_[i].ptr<float>(y);
      const int first = std::max(0, -right), end = std::min(size.width, size.width - right);
      for (int x = first; x < end; ++x) {
        const float scene = step_of(scene_here[x], scene_there[x + right]);
        const float step = step_of(here[x], there[x + right]) / (1 + scene / (kSceneEdge * kSceneEdge));
        weight[x] = -step / (2 * kEdge * kEdge);
      }
      cv::Mat row = weights_[i].row(y).colRange(first, std::max(first, end));
      cv::exp(row, row);
      for (int x = first; x < end; ++x) weight[x] *= kOneOfNine;
    }
  }
}

cv::Mat NeighbourVotes::of(const cv::Mat& chance) const {
  cv::Mat sum = kOneOfNine * chance;
  for (std::size_t i = 0; i < kToNeighbour.size(); ++i) {
    const auto [right, below] = kToNeighbour[i];
    for (int y = 0; y + below < chance.rows; ++y) {
      const auto* weight = weights_[i].ptr<float>(y);
      const auto* here = chance.ptr<float>(y);
      const auto* there = chance.ptr<float>(y + below);
      auto* sum_here = sum.ptr<float>(y);
      auto* sum_there = sum.ptr<float>(y + below);
      const int first = std::max(0, -right), end = std::min(chance.cols, chance.cols - right);
      for (int x = first; x < end; ++x) sum_here[x] += weight[x] * there[x + right];
      for (int x = first; x < end; ++x) sum_there[x + right] += weight[x] * here[x];
    }
  }
  return sum;
}

}  // namespace marey::track::contour::colour
