// Where a camera stands that sees wands whose places are known: three points give up to four poses (P3P), drawn at random; the one
// that explains most is kept (RANSAC). Reference: Gao, Hou, Tang & Cheng, "Complete solution classification for the
// perspective-three-point problem", 2003 (OpenCV's solveP3P); Fischler & Bolles, "Random sample consensus", 1981.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "marey/calibrate/marker_line.h"
#include "marey/core/geometry.h"
#include "marey/geometry/rigid.h"

namespace marey::calibrate {

/// A wand whose markers' places are known, and the bearings at which the camera sees them.
struct MarkObservation {
  std::array<Vector<3>, MarkerLine::maximum> world, bearing;
};

struct ResectionOptions {
  std::size_t markers = 1;
  bool reversible = false;  ///< the order of the bearings is not known
  double sigma = 1e-3;      ///< rad: noise of a bearing
  std::uint64_t seed = 1;
};

struct Resection {
  Rigid3 camera_from_world;
  std::vector<char> inlier, rotated;  ///< for each wand
  std::size_t inliers = 0;
};

/// Nothing if fewer than four wands or points are given, or no pose explains this many.
std::optional<Resection> resect(std::span<const MarkObservation> wands, const ResectionOptions& options);

}  // namespace marey::calibrate
