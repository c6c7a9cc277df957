#include "marey/simulate/people/sprites.h"

#include <cmath>
#include <vector>

namespace marey::simulate::people {
namespace {

/// Each block of 2 × 2 pixels takes its share of the colour.
void mix(const cv::Mat& chroma, const cv::Rect& blocks, const Ycc& colour, Planes& planes) {
  for (int y = 0; y < blocks.height; ++y) {
    for (int x = 0; x < blocks.width; ++x) {
      const float fraction = chroma.at<float>(y, x);
      auto& cb = planes.cb.at<std::uint8_t>(y + blocks.y, x + blocks.x);
      auto& cr = planes.cr.at<std::uint8_t>(y + blocks.y, x + blocks.x);
      cb = clamp_level((1 - fraction) * cb + fraction * colour[1]);
      cr = clamp_level((1 - fraction) * cr + fraction * colour[2]);
    }
  }
}

}  // namespace

Ycc to_ycc(const Rgb& rgb, double factor) {
  const double r = factor * rgb[0] / 255, g = factor * rgb[1] / 255, b = factor * rgb[2] / 255;
  const double y = 0.299 * r + 0.587 * g + 0.114 * b;
  return {static_cast<float>(16 + 219 * y), static_cast<float>(128 + 224 * (b - y) / 1.772),
          static_cast<float>(128 + 224 * (r - y) / 1.402)};
}

cv::Rect half_of(const cv::Rect& pixels) {
  const cv::Point first(pixels.x / 2, pixels.y / 2);
  return {first, cv::Point((pixels.br().x + 1) / 2, (pixels.br().y + 1) / 2)};
}

void Sprite::lay(Planes& planes) const {
  const cv::Rect all = shape.pixels();
  const cv::Rect shown = all & cv::Rect({0, 0}, planes.luma.size());
  const int samples = shape.samples;
  const float unit = 1.0F / static_cast<float>(samples * samples);
  struct Sum {
    float fraction = 0, y = 0, cb = 0, cr = 0;
  };
  const int chroma_left = shown.x / 2;
  std::vector<Sum> chroma(static_cast<std::size_t>(shown.br().x / 2 - chroma_left) + 1);
  for (int y = shown.y; y < shown.br().y; ++y) {
    auto* luma = planes.luma.ptr<std::uint8_t>(y);
    for (int x = shown.x; x < shown.br().x; ++x) {
      Sum sum;
      for (int row = 0; row < samples; ++row) {
        const auto* point = shape.mask.ptr<std::uint8_t>((y - all.y) * samples + row) + (x - all.x) * samples;
        for (int column = 0; column < samples; ++column) {
          if (point[column] == 0) continue;
          const Ycc& colour = palette[point[column]];
          sum = {sum.fraction + 1, sum.y + colour[0], sum.cb + colour[1], sum.cr + colour[2]};
        }
      }
      if (sum.fraction == 0) continue;
      luma[x] = clamp_level((1 - unit * sum.fraction) * luma[x] + unit * sum.y);
      Sum& cell = chroma[static_cast<std::size_t>(x / 2 - chroma_left)];
      cell = {cell.fraction + sum.fraction, 0, cell.cb + sum.cb, cell.cr + sum.cr};
    }
    if (y % 2 == 0 && y + 1 < shown.br().y) continue;
    auto* cb = planes.cb.ptr<std::uint8_t>(y / 2) + chroma_left;
    auto* cr = planes.cr.ptr<std::uint8_t>(y / 2) + chroma_left;
    for (std::size_t i = 0; i < chroma.size(); ++i) {
      if (chroma[i].fraction == 0) continue;
      cb[i] = clamp_level((1 - unit / 4 * chroma[i].fraction) * cb[i] + unit / 4 * chroma[i].cb);
      cr[i] = clamp_level((1 - unit / 4 * chroma[i].fraction) * cr[i] + unit / 4 * chroma[i].cr);
      chroma[i] = {};
    }
  }
}

bool Sprite::covers(const Vector<2>& at) const {
  const cv::Point point(static_cast<int>(std::floor((at.x() + 0.5) * shape.samples)),
                        static_cast<int>(std::floor((at.y() + 0.5) * shape.samples)));
  return shape.lattice.contains(point) && shape.mask.at<std::uint8_t>(point.y - shape.lattice.y, point.x - shape.lattice.x) != 0;
}

void BallSprite::lay(Planes& planes) const {
  constexpr int kMoments = 9, kPoints = 3;
  const Box box = bounds(RoundCone2{from, to, radius, radius});
  const cv::Rect shown = blank_silhouette(box, 1).pixels() & cv::Rect({0, 0}, planes.luma.size());
  if (shown.empty()) return;
  const cv::Rect blocks = half_of(shown) & cv::Rect({0, 0}, planes.cb.size());
  cv::Mat chroma = cv::Mat::zeros(blocks.size(), CV_32FC1);
  for (int y = shown.y; y < shown.br().y; ++y) {
    for (int x = shown.x; x < shown.br().x; ++x) {
      float fraction = 0, shade = 0;
      for (int sample = 0; sample < kMoments * kPoints * kPoints; ++sample) {
        const int point = sample / kMoments, column = point % kPoints, row = point / kPoints;
        const Vector<2> centre = from + (sample % kMoments + 0.5) / kMoments * (to - from);
        const Vector<2> off = Vector<2>(x + (column + 0.5) / kPoints - 0.5, y + (row + 0.5) / kPoints - 0.5) - centre;
        if (off.squaredNorm() > radius * radius) continue;
        fraction += 1;
        shade += static_cast<float>(0.86 - 0.14 * off.y() / radius);
      }
      if (fraction == 0) continue;
      constexpr float kUnit = 1.0F / (kMoments * kPoints * kPoints);
      auto& level = planes.luma.at<std::uint8_t>(y, x);
      level = clamp_level((1 - kUnit * fraction) * level + kUnit * (16 * fraction + shade * (colour[0] - 16)));
      if (x / 2 < blocks.br().x && y / 2 < blocks.br().y)
        chroma.at<float>(y / 2 - blocks.y, x / 2 - blocks.x) += kUnit * fraction / 4;
    }
  }
  mix(chroma, blocks, colour, planes);
}

}  // namespace marey::simulate::people
