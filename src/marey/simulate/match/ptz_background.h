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

/// What of the paint makes it hard to follow.
struct PtzPaint {
  double width = geometry::kPitchLineWidth;  ///< m
  double contrast = 1;                       ///< share of what white paint adds to the grass
  double missing = 0;                        ///< share of the lines' length that is worn away, in pieces of some metres
  int extra = 0;                             ///< straight pieces of paint, 8 to 30 m long, that belong to no football pitch
  double wet = 0;                            ///< 0 dry … 1: the lights shine in streaks on the grass
  int junior = 0;                            ///< pitches for children, across a half each, 0 to 2, as bright as the paint
  bool hockey = false;                       ///< the lines of field hockey in place of football's
  double mowing = 1;                         ///< how strongly the mown stripes differ, and their seams shine beyond 1
  bool mats = false;                         ///< green mats with white edges lie beside the lines
};

class PtzBackground {
 public:
  /// The pitch's own frame is the world: x along the near touchline, y away from the camera, z up.
  PtzBackground(const geometry::PitchSize& pitch, std::uint64_t seed, const PtzPaint& paint = {});

  /// CV_8UC3, blue first. The camera stands before y = 0.
  cv::Mat draw(const Camera& camera) const;

 private:
  cv::Mat texture_of(const Camera& camera) const;
  cv::Mat paint(const Camera& camera) const;

  geometry::PitchSize pitch_;
  PtzPaint appearance_;
  std::uint64_t seed_;
  std::vector<geometry::PitchLine> lines_;
  cv::Mat texture_;  // ground above, wall below, blue first
};

}  // namespace marey::simulate::match
