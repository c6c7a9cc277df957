// A row is cut into runs of pixels whose sources begin at one and the same offset, in whole pixels, from themselves. Within a run
// four arrays are read side by side, and only the weights between them change, by the same from pixel to pixel: compilers make
// vectors of that. The offset's fraction is exact every kStep pixels and straight between.
#include "marey/source/stabilise/fast_warp.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace marey::source::stabilise {
namespace {

constexpr int kStep =
    32;  // px, numerical, time against precision: a homography that is nearly the identity is straight within them

/// Bilinear over `count` pixels; the weights begin at fx, fy and grow by sx, sy.
template <typename Level>
void mix(const Level* above, const Level* below, Level* out, int count, float fx, float fy, float sx, float sy) {
  for (int i = 0; i < count; ++i) {
    const float wx = fx + sx * static_cast<float>(i), wy = fy + sy * static_cast<float>(i);
    const float a = static_cast<float>(above[i]), b = static_cast<float>(above[i + 1]);
    const float c = static_cast<float>(below[i]), d = static_cast<float>(below[i + 1]);
    const float top = a + wx * (b - a), bottom = c + wx * (d - c);
    out[i] = static_cast<Level>(static_cast<int>(top + wy * (bottom - top) + 0.5F));
  }
}

/// How many of `count` steps `at` + i · `step` stay in [0, 1).
int steps_within(double at, double step, int count) {
  if (step == 0) return count;
  const double to = step > 0 ? (1 - at) / step : -at / step;
  return to >= count ? count : std::max(1, static_cast<int>(std::ceil(to)));
}

struct Offset {
  double x, y;
};

Offset offset_at(const Matrix<3>& h, int x, int y) {
  const Vector<3> from = h * Vector<3>(x, y, 1);
  return {from.x() / from.z() - x, from.y() / from.z() - y};
}

template <typename Level>
void warp_row(const cv::Mat& image, const Matrix<3>& h, int y, Level* out) {
  for (int begin = 0; begin < image.cols; begin += kStep) {
    const int end = std::min(begin + kStep, image.cols);
    const Offset first = offset_at(h, begin, y), last = offset_at(h, end, y);
    const double sx = (last.x - first.x) / (end - begin), sy = (last.y - first.y) / (end - begin);
    for (int x = begin; x < end;) {
      const double dx = first.x + sx * (x - begin), dy = first.y + sy * (x - begin);
      const int whole_x = static_cast<int>(std::floor(dx)), whole_y = static_cast<int>(std::floor(dy));
      const double fx = dx - whole_x, fy = dy - whole_y;
      const int count = std::min(steps_within(fx, sx, end - x), steps_within(fy, sy, end - x));
      const int row = y + whole_y, from = x + whole_x;
      // Of the columns read the last is `from + count`.
      const int skip = std::clamp(-from, 0, count), keep = std::clamp(image.cols - 1 - from, skip, count);
      if (row >= 0 && row + 1 < image.rows && keep > skip) {
        const auto* above = image.ptr<Level>(row) + from + skip;
        const auto* below = image.ptr<Level>(row + 1) + from + skip;
        mix(above, below, out + x + skip, keep - skip, static_cast<float>(fx + sx * skip), static_cast<float>(fy + sy * skip),
            static_cast<float>(sx), static_cast<float>(sy));
      }
      x += count;
    }
  }
}

}  // namespace

void fast_warp(const cv::Mat& image, const Matrix<3>& picture_from_result, cv::Mat& result) {
  for (int y = 0; y < image.rows; ++y) {
    if (image.depth() == CV_16U) {
      warp_row(image, picture_from_result, y, result.ptr<std::uint16_t>(y));
    } else {
      warp_row(image, picture_from_result, y, result.ptr<std::uint8_t>(y));
    }
  }
}

}  // namespace marey::source::stabilise
