// In the order in which light meets them: the lens blurs, the camera sharpens (an unsharp mask, whose overshoot is the halo),
// chroma is filtered harder than luma and comes late, and the codec rounds the cosine coefficients of each block, more coarsely the
// faster they change. Cost: five separable filters and a cosine transform in each direction.
#include "marey/simulate/people/image_degradation.h"

#include <cmath>

#include <opencv2/imgproc.hpp>

namespace marey::simulate::people {
namespace {

void blur_plane(cv::Mat& plane, double sigma) {
  if (sigma > 0) cv::GaussianBlur(plane, plane, {}, sigma);
}

/// Rounds the coefficients of whole blocks; the rest at the right and below stays as it is.
void quantize_blocks(cv::Mat& plane, double step) {
  constexpr int kBlock = 8;
  cv::Mat block, coefficients;
  for (int y = 0; y + kBlock <= plane.rows; y += kBlock) {
    for (int x = 0; x + kBlock <= plane.cols; x += kBlock) {
      cv::Mat part = plane(cv::Rect(x, y, kBlock, kBlock));
      part.convertTo(block, CV_32F);
      cv::dct(block, coefficients);
      for (int v = 0; v < kBlock; ++v) {
        for (int u = 0; u < kBlock; ++u) {
          if (u + v == 0) continue;
          const auto coarse = static_cast<float>(step * (1 + 0.25 * (u + v)));
          float& value = coefficients.at<float>(v, u);
          value = coarse * std::trunc(value / coarse + (value < 0 ? -0.4F : 0.4F));  // small ones are dropped sooner
        }
      }
      cv::idct(coefficients, block);
      block.convertTo(part, CV_8U);
    }
  }
}

void shift_right(cv::Mat& plane, double by) {
  if (by == 0) return;
  const cv::Matx23d move(1, 0, by, 0, 1, 0);
  cv::Mat moved;
  cv::warpAffine(plane, moved, move, plane.size(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  plane = moved;
}

}  // namespace

void apply(const ImageDegradation& degradation, cv::Mat& luma, cv::Mat& cb, cv::Mat& cr) {
  if (degradation.plain()) return;
  blur_plane(luma, degradation.blur);
  if (degradation.halo > 0) {
    cv::Mat wide;
    cv::GaussianBlur(luma, wide, {}, degradation.halo_px);
    cv::addWeighted(luma, 1 + degradation.halo, wide, -degradation.halo, 0, luma);
  }
  for (cv::Mat* chroma : {&cb, &cr}) {
    blur_plane(*chroma, std::hypot(degradation.blur, degradation.chroma_bleed) / 2);
    shift_right(*chroma, degradation.chroma_shift / 2);
  }
  if (degradation.quantizer <= 0) return;
  quantize_blocks(luma, degradation.quantizer);
  quantize_blocks(cb, degradation.quantizer);
  quantize_blocks(cr, degradation.quantizer);
}

}  // namespace marey::simulate::people
