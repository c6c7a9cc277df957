// The white lines of a pitch in one image, where the camera is known to some pixels already.
//
// Every line is sampled; across each sample the image is read along the line's normal, and a ridge is searched for: brighter than
// the ground on both its sides, about as wide as paint. Which ridges are people's socks is left to who fits a camera to them, with
// a loss that cuts off. Cost: half a microsecond a sample, some two hundred samples an image.
// (calibrate/pitch/pitch_sightings.h searches for the same in one empty image with seconds of time and a lens that is not known.)
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/geometry.h"
#include "marey/geometry/pitch.h"
#include "marey/geometry/tripod.h"

namespace marey::calibrate::ptz {

/// A piece of paint: kept for every frame of a match, so small.
struct PaintSighting {
  Eigen::Vector2f ground = Eigen::Vector2f::Zero();  ///< m, in the world: the middle of the line
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();   ///< where paint is seen, px
  Eigen::Vector2f normal = Eigen::Vector2f::Zero();  ///< length 1, in the image, across the line
  float sigma = 1;                                   ///< px across the line
  std::int16_t line = 0;                             ///< which line of the model, or from kFirstClick on which axis of which click
};

inline constexpr std::int16_t kFirstClick = 1000;  // by definition

struct PaintOptions {
  double reach = 8;            ///< px to both sides of where a line is expected
  double apart = 7;            ///< px between samples of a line, at least
  double contrast = 5;         ///< grey levels above the brighter side
  double sigma_px = 0.4;       ///< of a ridge's place,
  double sigma_metres = 0.03;  ///< and of the paint's on the pitch
};

struct Paint {
  std::vector<PaintSighting> detected;
  int expected = 0;              ///< samples of lines that lie within the image,
  std::vector<int> expected_of;  ///< and of each line
};

/// `lines` in the world, evenly sampled; `luma` CV_8UC1.
Paint find_paint(const cv::Mat& luma, const geometry::Tripod& tripod, const geometry::Heading& heading,
                 std::span<const geometry::PitchLine> lines, const PaintOptions& options = {});

}  // namespace marey::calibrate::ptz
