#include "marey/track/contour/colour/body_mask.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace marey::track::contour::colour {
namespace {

constexpr float kSurest = 0.97F;  // no cell is certain, so that logarithms are finite; unswept
constexpr double kCoarser = 1.5;  // cells of the mask in one of the patch, from which on they are averaged: numerical

}  // namespace

cv::Mat chances_in(const BodyMask& mask, const ColourPatch& patch) {
  cv::Mat chances(patch.size(), CV_32FC1, cv::Scalar(0.5));
  if (mask.chance.empty()) return chances;
  const double cells = patch.step / mask.scale;
  cv::Mat smooth = mask.chance;
  if (cells > kCoarser) cv::GaussianBlur(mask.chance, smooth, {}, 0.4 * cells);
  const Vector<2> first = (patch.pixel({0, 0}) - mask.corner) / mask.scale;
  const cv::Matx23d to_mask(cells, 0, first.x(), 0, cells, first.y());
  cv::warpAffine(smooth, chances, to_mask, patch.size(), cv::INTER_LINEAR | cv::WARP_INVERSE_MAP, cv::BORDER_CONSTANT, 0.5);
  return chances;
}

float evidence_of(float chance) {
  const float bounded = std::clamp(chance, 1 - kSurest, kSurest);
  return std::log(bounded / (1 - bounded));
}

}  // namespace marey::track::contour::colour
