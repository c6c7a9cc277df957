// How two cameras stand to each other, from things that both saw at the same time.
//
// The essential matrix by the linear eight-point method on whitened bearings (so that any lens will do), inside RANSAC that draws
// whole wands rather than points, and draws both ways round where a wand's ends are not known; its four poses are tried against
// what lies before both cameras. Whether a single homography, or a bare rotation, explains the same is found too: then the scene is
// a plane or the cameras stand in one place, and no essential matrix means anything.
// References: Hartley, "In defense of the eight-point algorithm", 1997; Torr & Zisserman, "MLESAC", 2000; Hartley & Zisserman,
// "Multiple view geometry", 2004, chapters 9-11.
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

/// One instant of a wand as two cameras see it: bearings of length 1, marker by marker.
struct MarkPair {
  std::array<Vector<3>, MarkerLine::maximum> a, b;
};

struct TwoViewOptions {
  std::size_t markers = 1;                ///< of each pair, that are set
  bool reversible = false;                ///< the order of b's markers is not known
  double sigma_a = 1e-3, sigma_b = 1e-3;  ///< rad: noise of a bearing
  std::uint64_t seed = 1;
  int max_draws = 3000;  ///< of RANSAC, where little fits
};

struct TwoViews {
  Rigid3 b_from_a;            ///< the distance of the cameras is 1
  std::vector<char> inlier;   ///< for each pair
  std::vector<char> rotated;  ///< for each pair: b's markers are in the other order
  double fraction = 0;        ///< of inliers
  double parallax = 0;        ///< rad: median angle between the two rays to a marker
  bool plane = false;         ///< a homography explains the inliers as well
  bool one_position = false;  ///< a rotation does
};

/// Nothing if too few pairs are given (8 markers at least) or none of the drawn models explains a quarter of them. Of a plane,
/// where no essential matrix is determined, `plane` and `share` alone are set.
std::optional<TwoViews> relate(std::span<const MarkPair> pairs, const TwoViewOptions& options);

}  // namespace marey::calibrate
