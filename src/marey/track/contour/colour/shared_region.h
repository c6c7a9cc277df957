#pragma once

#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/geometry.h"
#include "marey/track/contour/colour/body_model.h"
#include "marey/track/contour/colour/colour_patch.h"

namespace marey::track::contour::colour {

/// One of several targets that share a region, and what the region's pixels say of it.
struct RegionMember {
  const BodyModel* body = nullptr;
  std::vector<Vector<2>> polygon;  ///< px; its predicted outline
  Vector<2> centre;                ///< px, of the polygon's area
  double height = 0;               ///< px
  double foot = 0;                 ///< px; the row of its feet, by which who stands nearer is known
  std::vector<Vector<2>> shifts;   ///< px; where it may be, against the polygon; at least one
  cv::Mat network = {};            ///< CV_32FC1: the chance that a cell shows it, by a network; empty: none was asked
  double typical = 0.4;            ///< share of its typical coverage in its prior, the rest being the polygon's

  Vector<2> shift = Vector<2>::Zero();  ///< px; where it is
  cv::Mat detected;                     ///< CV_32FC1: probability that a cell shows it
  cv::Mat whole;                        ///< the same with what others hide
  double visible = 0;                   ///< share of `whole` that is seen
  std::vector<int> behind;              ///< indices of members that hide a part of it
};

/// Divides the patch among the members and the ground, and says where each is. Returns the ground's colours (CV_32FC3), empty if
/// there is nothing to divide.
cv::Mat divide_region(const ColourPatch& patch, std::span<RegionMember> members);

}  // namespace marey::track::contour::colour
