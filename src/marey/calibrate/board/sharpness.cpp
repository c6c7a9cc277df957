#include "marey/calibrate/board/sharpness.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "marey/geometry/median.h"

namespace marey::calibrate::board {
namespace {

constexpr int kReach = 6;  // px to each side of a corner

/// Steepest step between neighbours over the range, around one pixel; 16-bit and 8-bit alike.
template <typename Pixel>
double steepness(const cv::Mat& luma, int column, int row) {
  double steepest = 0, low = luma.at<Pixel>(row, column), high = low;
  for (int y = row - kReach; y < row + kReach; ++y) {
    for (int x = column - kReach; x < column + kReach; ++x) {
      const double here = luma.at<Pixel>(y, x);
      const double right = luma.at<Pixel>(y, x + 1) - here, down = luma.at<Pixel>(y + 1, x) - here;
      steepest = std::max(steepest, std::hypot(right, down));
      low = std::min(low, here);
      high = std::max(high, here);
    }
  }
  return high > low ? std::min(1.0, steepest / (high - low)) : 0;
}

}  // namespace

double sharpness_of(const Image& image, const BoardView& view) {
  const cv::Mat& luma = image.luma();
  std::vector<double> values;
  for (const BoardCorner& corner : view.corners) {
    const int x = static_cast<int>(std::lround(corner.pixel.x())), y = static_cast<int>(std::lround(corner.pixel.y()));
    if (x < kReach || y < kReach || x >= luma.cols - kReach || y >= luma.rows - kReach) continue;
    values.push_back(luma.depth() == CV_16U ? steepness<unsigned short>(luma, x, y) : steepness<unsigned char>(luma, x, y));
  }
  if (values.empty()) return 0;
  return geometry::median(values);
}

}  // namespace marey::calibrate::board
