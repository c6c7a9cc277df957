#include "marey/source/stabilise/fast_warp.h"

#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace marey::source::stabilise {
namespace {

/// One pixel after the other, as the definition says.
cv::Mat warped_slowly(const cv::Mat& image, const Matrix<3>& from, const cv::Mat& under) {
  cv::Mat result = under.clone();
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const Vector<2> at = (from * Vector<3>(x, y, 1)).hnormalized();
      const int left = static_cast<int>(std::floor(at.x())), top = static_cast<int>(std::floor(at.y()));
      if (left < 0 || top < 0 || left + 1 >= image.cols || top + 1 >= image.rows) continue;
      const double fx = at.x() - left, fy = at.y() - top;
      const auto level = [&](int row, int column) { return static_cast<double>(image.at<std::uint8_t>(row, column)); };
      const double above = level(top, left) * (1 - fx) + level(top, left + 1) * fx;
      const double below = level(top + 1, left) * (1 - fx) + level(top + 1, left + 1) * fx;
      result.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(above * (1 - fy) + below * fy + 0.5);
    }
  }
  return result;
}

TEST(NearWarp, AgreesWithLookingUpEveryPixel) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(-1, 1);
    cv::Mat image(61, 97, CV_8UC1), under(image.size(), CV_8UC1, cv::Scalar(7));
    for (int i = 0; i < static_cast<int>(image.total()); ++i) image.data[i] = static_cast<std::uint8_t>(random() % 256);
    Matrix<3> from;
    from << 1 + 0.01 * unit(random), 0.03 * unit(random), 30 * unit(random), 0.03 * unit(random), 1 + 0.01 * unit(random),
        20 * unit(random), 2e-6 * unit(random), 2e-6 * unit(random), 1;
    const cv::Mat expected = warped_slowly(image, from, under);
    cv::Mat result = under.clone();
    fast_warp(image, from, result);
    // Between two pixels of one run the offset is straight, so that a source may lie on the other side of a pixel by a hair.
    int other = 0;
    for (int i = 0; i < static_cast<int>(result.total()); ++i) other += std::abs(result.data[i] - expected.data[i]) > 2 ? 1 : 0;
    EXPECT_LT(other, 0.003 * static_cast<double>(result.total()));
  }
}

}  // namespace
}  // namespace marey::source::stabilise
