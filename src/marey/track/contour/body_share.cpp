// A cell is a mixture of body and ground: its share of body is how far its colour has gone from the ground's to the body's, both
// taken from the neighbourhood (the ground outside the silhouette, the body where it differs most from that ground). A halo is
// ground that is too bright or too dark: it lies beyond the ground, or a small part of the way to the body; blur and smeared colour
// are symmetric, so that one half of the way is where the body ends. Cells deep inside belong to the body whatever their colour,
// unless they plainly are ground and lead outside (between legs, below an arm). Cost: some fifteen box filters.
#include "marey/track/contour/body_share.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace marey::track::contour {
namespace {

constexpr double kGroundReach = 0.15, kBodyReach = 0.07;  // heights: neighbourhoods that ground and body are read from
constexpr double kAway = 0.025;                           // heights: the ground is read this far from everything
constexpr double kRim = 0.07;                             // heights: how deep a silhouette's rim may be ground
constexpr float kLeastContrast = 16;                      // levels between body and ground, from which on colour tells
constexpr float kPlainGround = 12;                        // levels from the ground below which a cell deep inside is ground
constexpr float kHalo = 0.25F;                            // square of a halo's strength, of the step from ground to body
constexpr double kSmooth = 0.6;                           // cells

int odd_kernel(double radius) {
  return 2 * std::max(1, static_cast<int>(std::lround(radius))) + 1;
}

cv::Mat dilated(const cv::Mat& mask, double radius) {
  cv::Mat result;
  const int size = odd_kernel(radius);
  cv::dilate(mask, result, cv::getStructuringElement(cv::MORPH_ELLIPSE, {size, size}));
  return result;
}

/// Mean of the colours about each cell with these weights; where there are none, `otherwise`.
cv::Mat weighted_mean(const cv::Mat& colour, const cv::Mat& weights, int size, const cv::Scalar& otherwise) {
  cv::Mat sums(colour.size(), CV_32FC4);
  const auto fallback =
      cv::Vec3f(static_cast<float>(otherwise[0]), static_cast<float>(otherwise[1]), static_cast<float>(otherwise[2]));
  for (int y = 0; y < colour.rows; ++y) {
    const auto* in = colour.ptr<cv::Vec3f>(y);
    const float* weight = weights.ptr<float>(y);
    auto* out = sums.ptr<cv::Vec4f>(y);
    for (int x = 0; x < colour.cols; ++x) out[x] = {weight[x] * in[x][0], weight[x] * in[x][1], weight[x] * in[x][2], weight[x]};
  }
  cv::boxFilter(sums, sums, -1, {size, size}, {-1, -1}, true, cv::BORDER_CONSTANT);
  cv::Mat mean(colour.size(), CV_32FC3);
  for (int y = 0; y < colour.rows; ++y) {
    const auto* in = sums.ptr<cv::Vec4f>(y);
    auto* out = mean.ptr<cv::Vec3f>(y);
    for (int x = 0; x < colour.cols; ++x) {
      constexpr float kLittle = 1e-3F;  // of the weight: the fallback's, so that it fades in
      const float all = in[x][3] + kLittle;
      for (int k = 0; k < 3; ++k) out[x][k] = (in[x][k] + kLittle * fallback[k]) / all;
    }
  }
  return mean;
}

}  // namespace

cv::Mat ground_beside(const ColourPatch& patch, const cv::Mat& taken, double height) {
  const cv::Mat away = dilated(taken, std::max(2.0, kAway * height) / patch.step);
  cv::Mat free = 1 - away;
  cv::Mat somewhere;
  free.convertTo(somewhere, CV_8U, 255);
  const cv::Scalar everywhere = cv::mean(patch.colour, cv::countNonZero(somewhere) > 0 ? somewhere : cv::Mat());
  return weighted_mean(patch.colour, free, odd_kernel(kGroundReach * height / patch.step), everywhere);
}

cv::Mat body_share(const ColourPatch& patch, const cv::Mat& own, double height) {
  cv::Mat taken;
  cv::max(own, patch.mask, taken);
  const cv::Mat ground = ground_beside(patch, taken, height);
  cv::Mat weights(patch.size(), CV_32FC1), share(patch.size(), CV_32FC1);
  for (int y = 0; y < weights.rows; ++y) {
    for (int x = 0; x < weights.cols; ++x) {
      const cv::Vec3f away = patch.colour.at<cv::Vec3f>(y, x) - ground.at<cv::Vec3f>(y, x);
      const float square = away.dot(away);
      weights.at<float>(y, x) = own.at<float>(y, x) * square * square;
    }
  }
  const cv::Mat body =
      weighted_mean(patch.colour, weights, odd_kernel(std::max(4.0, kBodyReach * height) / patch.step), cv::Scalar());
  cv::Mat inside, depth;
  own.convertTo(inside, CV_8U, 255);
  cv::distanceTransform(inside, depth, cv::DIST_L2, 3);
  const cv::Mat near = dilated(own, 1);
  const auto rim = static_cast<float>(std::clamp(kRim * height, 3.0, 8.0) / patch.step);
  for (int y = 0; y < share.rows; ++y) {
    for (int x = 0; x < share.cols; ++x) {
      float& value = share.at<float>(y, x);
      value = own.at<float>(y, x);
      if (near.at<float>(y, x) == 0) continue;
      const cv::Vec3f way = body.at<cv::Vec3f>(y, x) - ground.at<cv::Vec3f>(y, x);
      const float contrast = way.dot(way);
      if (contrast < kLeastContrast * kLeastContrast) continue;
      const cv::Vec3f away = patch.colour.at<cv::Vec3f>(y, x) - ground.at<cv::Vec3f>(y, x);
      const float covered = std::clamp(away.dot(way) / contrast, 0.0F, 1.0F);
      const bool deep = depth.at<float>(y, x) > rim;
      // What is unlike both (dark hair over a white shirt) is body too; a halo is not as far from the ground as that.
      if (covered < 0.5F && away.dot(away) > kHalo * contrast) continue;
      if (!deep || away.dot(away) < kPlainGround * kPlainGround) value = covered;
    }
  }
  cv::GaussianBlur(share, share, {}, kSmooth);
  return share;
}

}  // namespace marey::track::contour
