#pragma once

#include <optional>

#include "marey/core/geometry.h"
#include "marey/core/outline.h"

namespace marey::analyse {

/// A figure and its standard deviation.
struct Figure {
  double value = 0, deviation = 0;
};

/// What a contour says of a body at one instant; deviations are those of the control points, carried through.
struct BodyShape {
  Figure area;         ///< px², of the whole body, hidden parts as they were held
  Figure width;        ///< px, from side to side
  Figure height;       ///< px, from head to foot
  Figure lean;         ///< degrees by which the body's longest axis leans to the right of upright; −90 … 90
  Figure leg_opening;  ///< px between the outer sides of the feet: the extent of the lowest seventh
};

/// Of a contour with at least as many control points as its order.
BodyShape body_shape(const Outline& outline);

/// The same person on the ground, of a camera that sees it.
struct BodyOnGround {
  Figure height;  ///< m above the ground where the feet are
  Figure scale;   ///< m for each px at the feet, upright: widths and openings times this are metres, areas its square
};

/// From the foot (the lowest point of the contour) and the head (the highest). Nothing if the foot is not on the ground that the
/// camera sees, or the camera is a homography alone, without heights.
std::optional<BodyOnGround> body_on_ground(const Outline& outline, const GroundView& view);

/// Whether a contour is good enough to be measured: found in its frame, with at most a quarter of its edge not seen.
bool is_measurable(const Outline& outline);

}  // namespace marey::analyse
