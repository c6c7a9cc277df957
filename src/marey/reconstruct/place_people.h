// Where people stand who are seen as boxes in a calibrated picture.
//
// The middle of a box's lower edge is the foot; its ray meets the ground (GroundView::place), and how far a pixel reaches there is
// the covariance: across the view some centimetres, along it a metre and more where the camera stands low and the person is far.
// Edges of boxes are wrong by a share of the box's height rather than by pixels. Where the whole camera is known, the upper edge
// counts too: a head is about 1.75 m above the feet. Both are joined as a Kalman filter would, linearised twice. Where the box is
// too short for a person who stands at its foot, and another box or the picture's lower edge hides what is missing, the legs are
// not seen and the head alone counts.
// Cost: two projections and a ray a person, about a microsecond; looking for who hides whom is quadratic in a frame's boxes.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "marey/core/detection.h"
#include "marey/core/geometry.h"
#include "marey/core/observation.h"
#include "marey/geometry/ground_view.h"

namespace marey::reconstruct {

/// Standard deviations where nothing else is said.
struct PlacePeopleOptions {
  double pixel_noise = 0.5;    ///< px, of each edge of a box,
  double edge_noise = 0.04;    ///< and so much of the box's height more
  double row_noise = 0.02;     ///< the same of rows that are known (PersonRows)
  double stride = 0.12;        ///< m; feet are in a stride before or behind where the body is
  double toe = 0;              ///< m; a box ends at the foot's nearest point, so far before the body's middle, seen along the view
  double height = 1.75;        ///< m, of a person from the ground to the crown
  double height_spread = 0.1;  ///< m, over people
  double row_height_spread = 0.25;  ///< m, of those whose rows are known: what is seen of their feet is better than any guess
};

/// In which rows a person is seen, px, where that is known better than by its box.
struct PersonRows {
  double head = 0;   ///< the upper edge of the head
  double stand = 0;  ///< where the person stands, less the toe
};

/// Who of a frame could be placed, in the order of the detections.
struct PlacedPeople {
  std::vector<Observation<2>> seen;  ///< m, on the world's ground
  std::vector<int> detection;        ///< of each: its index
};

/// Who stands at or above the horizon, or has an empty box, is left out. Whose region is shared with others is placed in its
/// middle, with a covariance that covers the region. `rows`: of each detection, or empty; they count for who is not in a shared
/// region.
PlacedPeople place_people(std::span<const Detection> detections, const GroundView& view, CameraId camera,
                          const PlacePeopleOptions& options = {}, std::span<const std::optional<PersonRows>> rows = {});

}  // namespace marey::reconstruct
