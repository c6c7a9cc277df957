// A pixel at the rim of a thing is a mixture of the thing and the ground behind it. A threshold on its difference from the ground
// calls it foreground when a small part of it is covered, so that masks come out half a pixel too wide all round, which is a
// quarter of the area of a player 25 px tall. Here the share that is covered is reported: the pixel's difference from the ground,
// over the mean difference of its neighbours that are wholly covered, along their direction in the space of luma and chroma. A rim
// pixel with no such neighbour (a thing two pixels wide) is compared with the one that differs most, and more kindly. Cost: four
// reads a foreground pixel, and some fifty for one at the rim.
#include "marey/detect/background/background_fringe.h"

#include <algorithm>
#include <array>

namespace marey::detect::background {
namespace {

constexpr float kCovered = 0.5F, kCoveredThin = 0.45F;

using Colour = std::array<float, 3>;

/// How a pixel differs from the ground, in levels.
Colour difference(int row, int column, const FramePlanes& frame, const SceneView& scene) {
  Colour result{};
  result[0] = static_cast<float>(frame.luma.at<std::uint8_t>(row, column)) - static_cast<float>(scene.luma.mean(row)[column]) / 128;
  if (frame.cb.empty()) return result;
  const int y = row / 2, x = column / 2;
  result[1] = static_cast<float>(frame.cb.at<std::uint8_t>(y, x)) - static_cast<float>(scene.cb.mean(y)[x]) / 128;
  result[2] = static_cast<float>(frame.cr.at<std::uint8_t>(y, x)) - static_cast<float>(scene.cr.mean(y)[x]) / 128;
  return result;
}

float product(const Colour& a, const Colour& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

bool at_rim(const std::uint8_t* pixel, std::size_t step) {
  return pixel[-1] == 0 || pixel[1] == 0 || *(pixel - step) == 0 || pixel[step] == 0;
}

bool predominantly_ground(const cv::Mat& mask, int row, int column, const FramePlanes& frame, const SceneView& scene) {
  Colour inner{}, strongest{};
  float maximum = 0;
  int count = 0;
  for (int y = row - 1; y <= row + 1; ++y) {
    for (int x = column - 1; x <= column + 1; ++x) {
      const std::uint8_t* pixel = mask.ptr<std::uint8_t>(y) + x;
      if (y < 1 || x < 1 || y >= mask.rows - 1 || x >= mask.cols - 1 || *pixel == 0) continue;
      const Colour one = difference(y, x, frame, scene);
      const float size = product(one, one);
      if (size > maximum) {
        maximum = size;
        strongest = one;
      }
      if (at_rim(pixel, mask.step)) continue;
      for (int k = 0; k < 3; ++k) inner[k] += one[k];
      ++count;
    }
  }
  const Colour own = difference(row, column, frame, scene);
  if (count == 0) return product(own, strongest) < kCoveredThin * maximum;
  return product(own, inner) * static_cast<float>(count) < kCovered * product(inner, inner);
}

}  // namespace

void trim_fringe(const cv::Mat& mask, std::span<const PixelRun> runs, const FramePlanes& frame, const SceneView& scene,
                 cv::Mat& covered) {
  for (const PixelRun& run : runs) {
    const auto* pixels = mask.ptr<std::uint8_t>(run.row);
    auto* kept = covered.ptr<std::uint8_t>(run.row);
    std::copy(pixels + run.begin, pixels + run.end, kept + run.begin);
    if (run.row == 0 || run.row == mask.rows - 1) continue;
    for (int x = std::max(run.begin, 1); x < std::min(run.end, mask.cols - 1); ++x) {
      if (pixels[x] == 0 || !at_rim(pixels + x, mask.step)) continue;
      if (predominantly_ground(mask, run.row, x, frame, scene)) kept[x] = 0;
    }
  }
}

}  // namespace marey::detect::background
