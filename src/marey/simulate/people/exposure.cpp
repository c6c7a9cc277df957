#include "marey/simulate/people/exposure.h"

#include <opencv2/imgproc.hpp>

namespace marey::simulate::people {
namespace {

constexpr int kGrid = 16;  // px; between its points a map is as good as linear

/// The directions of the pixels of a plane of `size`, for cv::remap. A plane of chroma is half as large: `scale` 2.
cv::Mat lookup(const PixelMap& map, cv::Size size, int margin, int scale) {
  const cv::Size grid(size.width / kGrid + 2, size.height / kGrid + 2);
  cv::Mat_<cv::Vec2f> coarse(grid);
  const double half = (scale - 1) / 2.0;  // a chroma sample lies between its pixels
  for (int y = 0; y < grid.height; ++y) {
    for (int x = 0; x < grid.width; ++x) {
      const Vector<2> at = map(Vector<2>(scale * kGrid * x + half, scale * kGrid * y + half));
      coarse(y, x) = {static_cast<float>((at.x() + margin - half) / scale), static_cast<float>((at.y() + margin - half) / scale)};
    }
  }
  const float by = 1.0F / kGrid;
  cv::Mat fine;
  const cv::Matx23f to_grid(by, 0, 0, 0, by, 0);
  cv::warpAffine(coarse, fine, to_grid, size, cv::INTER_LINEAR | cv::WARP_INVERSE_MAP, cv::BORDER_REPLICATE);
  return fine;
}

cv::Mat mean_of(const cv::Mat& plane, const std::vector<PixelMap>& time_steps, int margin, int scale) {
  const cv::Size size(plane.cols - 2 * margin / scale, plane.rows - 2 * margin / scale);
  cv::Mat sum = cv::Mat::zeros(size, CV_32F);
  for (const PixelMap& map : time_steps) {
    cv::Mat detected, as_float;
    cv::remap(plane, detected, lookup(map, size, margin, scale), cv::Mat(), cv::INTER_CUBIC, cv::BORDER_REPLICATE);
    detected.convertTo(as_float, CV_32F);
    sum += as_float;
  }
  cv::Mat mean;
  sum.convertTo(mean, CV_8U, 1.0 / static_cast<double>(time_steps.size()));
  return mean;
}

}  // namespace

Planes observed_through(const Planes& planes, const std::vector<PixelMap>& time_steps, int margin) {
  Planes result;
  if (time_steps.empty()) {
    const auto inner = [](const cv::Mat& plane, int edge) {
      return plane({edge, edge, plane.cols - 2 * edge, plane.rows - 2 * edge}).clone();
    };
    return {inner(planes.luma, margin), inner(planes.cb, margin / 2), inner(planes.cr, margin / 2)};
  }
  result.luma = mean_of(planes.luma, time_steps, margin, 1);
  result.cb = mean_of(planes.cb, time_steps, margin, 2);
  result.cr = mean_of(planes.cr, time_steps, margin, 2);
  return result;
}

}  // namespace marey::simulate::people
