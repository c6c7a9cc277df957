#pragma once

#include <functional>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/geometry.h"
#include "marey/core/image.h"
#include "marey/track/contour/colour/colour_patch.h"

namespace marey::track::contour::colour {

/// What a network says of the pixels about one person.
struct BodyMask {
  cv::Mat chance;                        ///< CV_32FC1, 0 … 1, that a cell shows the person; empty without one
  Vector<2> corner = Vector<2>::Zero();  ///< px of the image: the middle of the first cell
  double scale = 1;                      ///< px of the image from cell to cell
};

/// Asks for the people in boxes (px) of an image: one mask for each, in their order.
using FindBodyMasks = std::function<std::vector<BodyMask>(const Image&, std::span<const Box>)>;

/// The mask in a patch's cells (CV_32FC1); one half, which says nothing, where the mask does not reach.
cv::Mat chances_in(const BodyMask& mask, const ColourPatch& patch);

/// What it adds to the log-odds of a cell that the network gives this chance (a network is sure of much that is wrong).
float evidence_of(float chance);

}  // namespace marey::track::contour::colour
