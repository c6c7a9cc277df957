// The empty scene of a match from a PTZ camera: another image every frame, so that it has to be drawn fast.
//
// Grass and what stands round it (boards with letters, a stand full of people, a sky) are textures of the ground and of three
// upright walls, drawn once and retrieved by each pixel's ray: so nearer things move against farther ones as the centre of
// projection moves, as in a real stadium. Lines are drawn every frame as polygons four times finer than the pixels, so that paint
// has its place to some hundredths of a pixel however narrow it is. Cost: some 30 ms for 1280 × 720 px.
#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

#include "marey/core/geometry.h"
#include "marey/geometry/camera.h"
#include "marey/geometry/pitch.h"

namespace marey::simulate::match {

class PtzBackground {
 public:
  /// The pitch's own frame is the world: x along the near touchline, y away from the camera, z up.
  PtzBackground(const geometry::PitchSize& pitch, std::uint64_t seed);

  /// CV_8UC3, blue first. The camera stands before y = 0.
  cv::Mat draw(const Camera& camera) const;

 private:
  cv::Mat inspected_up(const Camera& camera) const;
  cv::Mat paint(const Camera& camera) const;

  geometry::PitchSize pitch_;
  std::vector<geometry::PitchLine> lines_;
  cv::Mat texture_;  // ground above, wall below, blue first
};

}  // namespace marey::simulate::match
