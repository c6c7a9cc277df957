// A share of a region's cells says which side of an edge a cell is on; where within the cell the edge runs says its colour, which
// is a mixture of the body's and the ground's in the ratio of their areas (Porter & Duff, "Compositing digital images", 1984). A
// symmetric blur keeps the middle of that mixture in place, and so does the overshoot of sharpening. Chroma has half the resolution
// and is coded more coarsely, therefore it has less weight than luma.
#include "marey/track/contour/colour/edge_matting.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace marey::track::contour::colour {
namespace {

constexpr double kBodyReach = 0.06;     // heights: the neighbourhood that the colour inside is read from; unswept
constexpr float kChromaWeight = 0.4F;   // of squared differences; unswept
constexpr double kBorder = 1.5;         // cells to either side of the 0.5 level that are matted; unswept
constexpr float kMinEdgeContrast = 18;  // levels between body and ground from which on colours are used; unswept
constexpr float kBlocked = 0.1F;

float weighted_dot(const cv::Vec3f& a, const cv::Vec3f& b) {
  return a[0] * b[0] + kChromaWeight * (a[1] * b[1] + a[2] * b[2]);
}

/// Mean colour inside the body about each cell, with the number of cells it is of in the fourth channel.
cv::Mat colours_inside(const ColourPatch& patch, const cv::Mat& core, double radius) {
  cv::Mat sums(core.size(), CV_32FC4);
  for (int y = 0; y < core.rows; ++y) {
    const auto* colour = patch.colour.ptr<cv::Vec3f>(y);
    const auto* weight = core.ptr<std::uint8_t>(y);
    auto* sum = sums.ptr<cv::Vec4f>(y);
    for (int x = 0; x < core.cols; ++x) {
      const float one = weight[x] != 0 ? 1.0F : 0.0F;
      sum[x] = {one * colour[x][0], one * colour[x][1], one * colour[x][2], one};
    }
  }
  const int size = 2 * std::max(1, static_cast<int>(std::lround(radius))) + 1;
  cv::boxFilter(sums, sums, -1, {size, size}, {-1, -1}, false, cv::BORDER_CONSTANT);
  return sums;
}

}  // namespace

cv::Mat matted_edge(const ColourPatch& patch, const cv::Mat& fraction, const cv::Mat& blocked, const cv::Mat& ground,
                    double height) {
  const cv::Mat inside = fraction > 0.5F;
  cv::Mat depth, distance;
  cv::distanceTransform(inside, depth, cv::DIST_L2, 3);
  cv::distanceTransform(inside == 0, distance, cv::DIST_L2, 3);
  const double radius = std::max(2.0, kBodyReach * height / patch.step);
  const cv::Mat deep = colours_inside(patch, depth > 1.5F, radius), any = colours_inside(patch, inside, radius);
  cv::Mat result = fraction.clone();
  for (int y = 0; y < fraction.rows; ++y) {
    for (int x = 0; x < fraction.cols; ++x) {
      const float from_edge = std::max(depth.at<float>(y, x), distance.at<float>(y, x)) - 0.5F;
      if (from_edge > kBorder) {
        result.at<float>(y, x) = inside.at<std::uint8_t>(y, x) != 0 ? 1.0F : 0.0F;
        continue;
      }
      if (!blocked.empty() && blocked.at<float>(y, x) > kBlocked) continue;
      const cv::Vec4f& sum = deep.at<cv::Vec4f>(y, x)[3] >= 3 ? deep.at<cv::Vec4f>(y, x) : any.at<cv::Vec4f>(y, x);
      if (sum[3] < 1) continue;
      const cv::Vec3f& outside = ground.at<cv::Vec3f>(y, x);
      const cv::Vec3f step = cv::Vec3f(sum[0], sum[1], sum[2]) / sum[3] - outside;
      const float contrast = weighted_dot(step, step);
      if (contrast < kMinEdgeContrast * kMinEdgeContrast) continue;
      const cv::Vec3f off = patch.colour.at<cv::Vec3f>(y, x) - outside;
      result.at<float>(y, x) = std::clamp(weighted_dot(off, step) / contrast, 0.0F, 1.0F);
    }
  }
  return result;
}

}  // namespace marey::track::contour::colour
