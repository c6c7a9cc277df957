// A colour is off by noise, and by its slope times how far it may be displaced: chroma is filtered harder than luma and coded at
// half the resolution, therefore a cell beside a red shirt is reddish without any of the shirt in it. The displacement adds to the
// variance, so that such a cell says little, and luma, whose edge is sharp, decides. A shadow takes the same share of luma and of
// the distance of chroma from grey (Horprasert, Harwood & Davis, "A statistical approach for real-time robust background
// subtraction and shadow detection", 1999); its depth is not known, so several are tried. Cost: five exponentials a cell.
#include "marey/track/contour/colour/ground_likelihood.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace marey::track::contour::colour {
namespace {

constexpr float kGroundLuma = 11, kGroundChroma = 4;                // levels, standard deviation of the ground beside people
constexpr float kLumaDisplaced = 0.3F, kChromaDisplaced = 1.5F;     // cells, standard deviation
constexpr float kShadowed = 0.1F;                                   // share of the ground beside people
constexpr std::array<float, 4> kLights{0.45F, 0.6F, 0.75F, 0.88F};  // that a shadow leaves; unswept
constexpr float kGroundFloor = 2e-7F;                               // per level³
constexpr float kMaskOnGround = 0.2F, kMaskOnBody = 0.92F;          // chance of foreground
constexpr float kBlack = 16, kGrey = 128;                           // levels; format

float squared(float value) {
  return value * value;
}

struct GroundSlopes {
  float luma = 0, chroma = 0;  ///< levels a cell
};

GroundSlopes slopes_at(const cv::Mat& colour, int y, int x) {
  const auto* row = colour.ptr<cv::Vec3f>(y);
  const cv::Vec3f across = 0.5F * (row[std::min(x + 1, colour.cols - 1)] - row[std::max(x - 1, 0)]);
  const cv::Vec3f down =
      0.5F * (colour.at<cv::Vec3f>(std::min(y + 1, colour.rows - 1), x) - colour.at<cv::Vec3f>(std::max(y - 1, 0), x));
  return {std::sqrt(across[0] * across[0] + down[0] * down[0]),
          std::sqrt(across[1] * across[1] + across[2] * across[2] + down[1] * down[1] + down[2] * down[2])};
}

}  // namespace

float mask_chance_on_body(float mask) {
  return mask * kMaskOnBody + (1 - mask) * (1 - kMaskOnBody);
}

cv::Mat ground_likelihood(const ColourPatch& patch, const cv::Mat& ground) {
  constexpr auto kTimesNormal = static_cast<float>(1 / (2 * std::numbers::pi * 2.5066282746310002));  // (2π)^(−3/2), by definition
  const cv::Vec3f zero(kBlack, kGrey, kGrey);
  cv::Mat likelihood(patch.size(), CV_32FC1);
  // Of a row: the exponents with each light, the last of them full; then what they come to. And what that is multiplied by.
  const int full = static_cast<int>(kLights.size());
  cv::Mat fits(full + 1, ground.cols, CV_32FC1);
  std::vector<float> scales(static_cast<std::size_t>(ground.cols));
  float* const scale = scales.data();
  for (int y = 0; y < ground.rows; ++y) {
    const auto* colour = patch.colour.ptr<cv::Vec3f>(y);
    const auto* scene_row = ground.ptr<cv::Vec3f>(y);
    const float* mask = patch.mask.ptr<float>(y);
    float* result = likelihood.ptr<float>(y);
    for (int x = 0; x < ground.cols; ++x) {
      const cv::Vec3f here = colour[x] - zero, scene = scene_row[x] - zero;
      const GroundSlopes slopes = slopes_at(patch.colour, y, x);
      const float luma = squared(kGroundLuma) + squared(kLumaDisplaced * slopes.luma);
      const float chroma = squared(kGroundChroma) + squared(kChromaDisplaced * slopes.chroma);
      for (int k = 0; k <= full; ++k) {
        const cv::Vec3f off = here - (k < full ? kLights[static_cast<std::size_t>(k)] : 1.0F) * scene;
        fits.ptr<float>(k)[x] = -0.5F * (off[0] * off[0] / luma + (off[1] * off[1] + off[2] * off[2]) / chroma);
      }
      scale[x] = kTimesNormal / (std::sqrt(luma) * chroma);
    }
    cv::exp(fits, fits);
    for (int x = 0; x < ground.cols; ++x) {
      float shaded = 0;
      for (int k = 0; k < full; ++k) shaded += fits.ptr<float>(k)[x] / static_cast<float>(full);
      const float density = scale[x] * ((1 - kShadowed) * fits.ptr<float>(full)[x] + kShadowed * shaded) + kGroundFloor;
      result[x] = density * (mask[x] * kMaskOnGround + (1 - mask[x]) * (1 - kMaskOnGround));
    }
  }
  return likelihood;
}

}  // namespace marey::track::contour::colour
