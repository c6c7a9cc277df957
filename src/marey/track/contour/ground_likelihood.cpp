// A colour is off by noise, and by its slope times how far it may be displaced: chroma is filtered harder than luma and coded at
// half the resolution, therefore a cell beside a red shirt is reddish without any of the shirt in it. The displacement adds to the
// variance, so that such a cell says little, and luma, whose edge is sharp, decides. A shadow takes the same share of luma and of
// the distance of chroma from grey (Horprasert, Harwood & Davis, "A statistical approach for real-time robust background
// subtraction and shadow detection", 1999); its depth is not known, so several are tried. Cost: five exponentials a cell.
#include "marey/track/contour/ground_likelihood.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace marey::track::contour {
namespace {

constexpr double kGroundLuma = 11, kGroundChroma = 4;            // levels, standard deviation of the ground beside people
constexpr double kLumaDisplaced = 0.3, kChromaDisplaced = 1.5;   // cells, standard deviation
constexpr double kShadowed = 0.1;                                // share of the ground beside people
constexpr std::array<double, 4> kLights{0.45, 0.6, 0.75, 0.88};  // that a shadow leaves; unswept
constexpr double kGroundFloor = 2e-7;                            // per level³
constexpr float kMaskOnGround = 0.2F, kMaskOnBody = 0.92F;       // chance of foreground
constexpr float kBlack = 16, kGrey = 128;                        // levels; format

struct GroundSlopes {
  float luma = 0, chroma = 0;  ///< levels a cell
};

GroundSlopes slopes_at(const cv::Mat& colour, int y, int x) {
  const auto* row = colour.ptr<cv::Vec3f>(y);
  const cv::Vec3f across = 0.5F * (row[std::min(x + 1, colour.cols - 1)] - row[std::max(x - 1, 0)]);
  const cv::Vec3f down =
      0.5F * (colour.at<cv::Vec3f>(std::min(y + 1, colour.rows - 1), x) - colour.at<cv::Vec3f>(std::max(y - 1, 0), x));
  return {std::hypot(across[0], down[0]),
          std::sqrt(across[1] * across[1] + across[2] * across[2] + down[1] * down[1] + down[2] * down[2])};
}

}  // namespace

float mask_chance_on_body(float mask) {
  return mask * kMaskOnBody + (1 - mask) * (1 - kMaskOnBody);
}

cv::Mat ground_likelihood(const ColourPatch& patch, const cv::Mat& ground) {
  cv::Mat likelihood(patch.size(), CV_32FC1);
  for (int y = 0; y < ground.rows; ++y) {
    for (int x = 0; x < ground.cols; ++x) {
      const cv::Vec3f& here = patch.colour.at<cv::Vec3f>(y, x);
      const cv::Vec3f scene = ground.at<cv::Vec3f>(y, x) - cv::Vec3f(kBlack, kGrey, kGrey);
      const GroundSlopes slopes = slopes_at(patch.colour, y, x);
      const double luma = kGroundLuma * kGroundLuma + std::pow(kLumaDisplaced * slopes.luma, 2);
      const double chroma = kGroundChroma * kGroundChroma + std::pow(kChromaDisplaced * slopes.chroma, 2);
      const auto fits = [&](double light) {
        const cv::Vec3f off = here - static_cast<float>(light) * scene - cv::Vec3f(kBlack, kGrey, kGrey);
        return std::exp(-0.5 * (off[0] * off[0] / luma + (off[1] * off[1] + off[2] * off[2]) / chroma));
      };
      double shaded = 0;
      for (const double light : kLights) shaded += fits(light) / kLights.size();
      const double scale = std::pow(2 * std::numbers::pi, -1.5) / (std::sqrt(luma) * chroma);
      const double density = scale * ((1 - kShadowed) * fits(1) + kShadowed * shaded) + kGroundFloor;
      const float mask = patch.mask.at<float>(y, x);
      likelihood.at<float>(y, x) = static_cast<float>(density) * (mask * kMaskOnGround + (1 - mask) * (1 - kMaskOnGround));
    }
  }
  return likelihood;
}

}  // namespace marey::track::contour
