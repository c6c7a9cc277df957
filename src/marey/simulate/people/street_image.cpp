#include "marey/simulate/people/street_image.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "marey/simulate/random.h"
#include "marey/simulate/value_noise.h"

namespace marey::simulate::people {
namespace {

constexpr int kFiner = 2;              // drawn this many times larger, for edges that are not steps
constexpr double kPavementFrom = 0.4;  // of the height
constexpr double kKerb = 0.72;         // of the height

cv::Scalar tinted(Random& random, double grey, double tint) {
  return {grey + random.uniform(-tint, tint), grey + random.uniform(-tint, tint) / 2, grey + random.uniform(-tint, tint)};
}

void draw_front(cv::Mat& bgr, int bottom, Random& random) {
  bgr.rowRange(0, bottom).setTo(tinted(random, random.uniform(120, 165), 18));
  const int wide = kFiner * random.integer(22, 30), high = kFiner * random.integer(28, 38);
  for (int y = wide / 4; y < bottom; y += high) {
    for (int x = wide / 3; x < bgr.cols; x += wide) {
      const cv::Rect window(x, y, wide / 2, std::min(high * 2 / 3, bottom - y));
      const double glass = random.uniform(25, 75);
      cv::rectangle(bgr, window, tinted(random, glass, 10), cv::FILLED);
      cv::rectangle(bgr, window, tinted(random, 205, 8), kFiner);
      cv::line(bgr, {x + wide / 4, y}, {x + wide / 4, window.br().y - 1}, cv::Scalar(210, 210, 205), kFiner);
      if (random.chance(0.4)) cv::rectangle(bgr, {x, y, wide / 2, window.height / 2}, tinted(random, 150, 50), cv::FILLED);
    }
  }
}

/// Rows of slabs that grow towards the camera, a dark kerb, and the road's white line before it.
void draw_pavement(cv::Mat& bgr, int top, Random& random) {
  const int kerb = static_cast<int>(kKerb * bgr.rows);
  double y = top;
  for (int row = 0; y < bgr.rows; ++row) {
    const double deep = kFiner * (3 + 11 * (y - top) / (bgr.rows - top));
    const double wide = 2.2 * deep;
    for (double x = -(row % 2) * wide / 2; x < bgr.cols; x += wide) {
      const cv::Rect slab(cv::Point(static_cast<int>(x), static_cast<int>(y)),
                          cv::Point(static_cast<int>(x + wide), static_cast<int>(y + deep)));
      const double grey = y < kerb ? random.uniform(118, 146) : random.uniform(82, 92);
      cv::rectangle(bgr, slab, tinted(random, grey, 4), cv::FILLED);
      if (y < kerb) cv::rectangle(bgr, slab, cv::Scalar(84, 86, 88), 1);
    }
    y += deep;
  }
  cv::rectangle(bgr, {0, kerb, bgr.cols, 3 * kFiner}, cv::Scalar(60, 62, 64), cv::FILLED);
  const int line = kerb + (bgr.rows - kerb) / 2;
  for (int x = 0; x < bgr.cols; x += kFiner * 60)
    cv::rectangle(bgr, {x, line, kFiner * 36, 4 * kFiner}, cv::Scalar(215, 215, 210), -1);
}

}  // namespace

Image draw_street(cv::Size size, std::uint64_t seed) {
  Random random(seed * 48271 + 5);
  cv::Mat fine(size.height * kFiner, size.width * kFiner, CV_8UC3);
  const int pavement = static_cast<int>(kPavementFrom * fine.rows);
  draw_pavement(fine, pavement, random);
  draw_front(fine, pavement, random);
  cv::Mat bgr;
  cv::resize(fine, bgr, size, 0, 0, cv::INTER_AREA);
  for (int y = 0; y < bgr.rows; ++y) {
    for (int x = 0; x < bgr.cols; ++x) {
      const double rough = 1 + 0.05 * value_noise(Vector<2>(x, y) / 2.3, seed) + 0.05 * value_noise(Vector<2>(x, y) / 17, seed + 1);
      auto& pixel = bgr.at<cv::Vec3b>(y, x);
      for (int i = 0; i < 3; ++i) pixel[i] = cv::saturate_cast<std::uint8_t>(pixel[i] * rough);
    }
  }
  return Image::from_bgr(bgr);
}

}  // namespace marey::simulate::people
