// Where people stand who are seen as boxes in a calibrated image.
//
// The middle of a box's lower edge is the foot; its ray meets the ground (GroundView::place), and how far a pixel reaches there is
// the covariance: across the view some centimetres, along it a metre and more where the camera stands low and the person is far.
// Edges of boxes are wrong by a share of the box's height rather than by pixels. Where the whole camera is known, the upper edge
// counts too: a head is about 1.75 m above the feet. Both are joined as a Kalman filter would, linearised twice. Where the box is
// too short for a person who stands at its foot, and another box or the image's lower edge hides the missing part, the legs are
// not seen and the head alone counts.
// Cost: two projections and a ray a person, about a microsecond; the search for occlusions is quadratic in a frame's boxes.
#pragma once

#include <span>
#include <vector>

#include "marey/core/detection.h"
#include "marey/core/geometry.h"
#include "marey/core/observation.h"
#include "marey/geometry/ground_view.h"

namespace marey::reconstruct {

/// Standard deviations where nothing else is said.
struct LocalisePeopleOptions {
  double pixel_noise = 0.5;    ///< px, of each edge of a box,
  double edge_noise = 0.04;    ///< and this much of the box's height more
  double stride = 0.12;        ///< m; feet are in a stride before or behind where the body is
  double toe = 0;              ///< m; a box ends at the foot's nearest point, so far before the body's middle, seen along the view
  double height = 1.75;        ///< m, of a person from the ground to the crown
  double height_spread = 0.1;  ///< m, over people
};

/// Who of a frame could be placed, in the order of the detections.
struct LocatedPeople {
  std::vector<Observation<2>> detected;  ///< m, on the world's ground
  std::vector<int> detection;            ///< of each: its index
};

/// Who stands at or above the horizon, or has an empty box, is omitted. Whose region is shared with others is placed in its
/// middle, with a covariance that covers the region.
LocatedPeople localise_people(std::span<const Detection> detections, const GroundView& view, CameraId camera,
                              const LocalisePeopleOptions& options = {});

}  // namespace marey::reconstruct
