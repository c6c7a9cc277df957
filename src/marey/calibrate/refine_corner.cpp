#include "marey/calibrate/refine_corner.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace marey {

std::optional<Vector<2>> refine_corner(const cv::Mat& grey, const Vector<2>& start, double spacing) {
  const int half = std::clamp(static_cast<int>(std::lround(0.4 * spacing)), 2, 11);
  if (start.x() < half || start.y() < half || start.x() > grey.cols - 1 - half || start.y() > grey.rows - 1 - half)
    return std::nullopt;
  std::vector<cv::Point2f> corner{{static_cast<float>(start.x()), static_cast<float>(start.y())}};
  cv::cornerSubPix(grey, corner, {half, half}, {-1, -1}, {cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 50, 1e-3});
  const Vector<2> pixel(corner[0].x, corner[0].y);
  if ((pixel - start).norm() > std::max(1.5, 0.3 * spacing)) return std::nullopt;
  return pixel;
}

}  // namespace marey
