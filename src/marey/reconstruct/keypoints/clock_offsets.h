// By how much cameras were started after each other, by how people move before them: at the right offset the half-lines to a
// person's points meet.
//
// For two cameras and a candidate offset, each person of the one is compared with every person of the other at the frame that the
// offset names; the best counts, by the mean bounded squared distance of the half-lines. Near its least value that is a parabola
// over the offset, whose vertex lies between frames; its curvature says how much the pair knows (nothing, where no person moves
// across the half-planes through both cameras). All pairs' parabolas together give the offsets by least squares. How sure they are
// is said by omitting one tenth of the time after another (the jackknife; Efron and Tibshirani, "An Introduction to the Bootstrap",
// 1993, chapter 11), and by how far the pairs disagree, as they do where the calibration is off. Cost: pairs of cameras × samples ×
// offsets × pairs of people × keypoints.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "marey/core/keypoints.h"
#include "marey/geometry/camera.h"

namespace marey::reconstruct::keypoints {

/// A camera and its images' people; frame k was exposed at k / rate_hz + offset_s.
struct CameraFrames {
  const Camera* camera = nullptr;  ///< nothing: it does not take part
  const std::vector<std::vector<Keypoints<2>>>* people = nullptr;
  double rate_hz = 0, offset_s = 0;
  bool known = false;  ///< the offset is right
};

struct ClockOffset {
  double offset_s = 0;
  double sigma_s = 0;  ///< one standard deviation
};

struct ClockOptions {
  double farthest_s = 0.5;  ///< from the offset that the camera has
  int samples = 200;        ///< frames of a camera that are compared
  double vertex_s = 0.07;   ///< half the width of the parabola, at least two frames
  double max_sigma = 1;     ///< frames: an offset less certain than that is unknown
};

/// Of each camera whose offset is not known, against those that are known, or else the first one. Nothing for the others, and for
/// one that the motion does not determine.
std::vector<std::optional<ClockOffset>> find_clock_offsets(std::span<const CameraFrames> cameras, const ClockOptions& options = {});

}  // namespace marey::reconstruct::keypoints
