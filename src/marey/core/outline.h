#pragma once

#include <optional>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/core/ids.h"

namespace marey {

/// Where the outline of a target was searched for: a straight line across the predicted curve.
struct MeasurementLine {
  enum class Finding {
    found,    ///< the outline crosses it at `offset`
    nothing,  ///< nothing that could be the outline
    hidden,   ///< another target owns the pixels there, or something of the scene hides them
    outlier,  ///< found, and not trusted: it contradicts the other lines
    outside,  ///< it leaves the image
  };

  Vector<2> foot = Vector<2>::Zero();    ///< px; its middle, on the predicted curve
  Vector<2> normal = Vector<2>::Zero();  ///< unit length, out of the target
  double reach = 0;                      ///< px it extends to either side
  Finding finding = Finding::nothing;
  double offset = 0;    ///< px along `normal` from `foot`; 0 where nothing was found
  double variance = 1;  ///< of `offset`, px²
};

/// The outline of a target at one instant: a closed uniform B-spline (geometry/bspline.h), how it moves, and how well all is known.
struct Outline {
  enum class State {
    detected,  ///< most of it was found in this frame
    partly,    ///< some of it; the rest is hidden, or was not found
    held,      ///< it moves as before with its shape held: too little was found to say more
  };

  int order = 4;                                     ///< degree + 1
  std::vector<Vector<2>> control_points;             ///< px; clockwise as seen on the screen; at least `order`
  std::vector<Vector<2>> deviations;                 ///< standard deviation of each, px
  Vector<2> centre = Vector<2>::Zero();              ///< px; of the area, as the motion filter holds it
  Vector<2> velocity = Vector<2>::Zero();            ///< px/s
  double scale_rate = 0;                             ///< relative growth of lengths, 1/s
  Vector<2> centre_deviation = Vector<2>::Zero();    ///< px
  Vector<2> velocity_deviation = Vector<2>::Zero();  ///< px/s
  double scale_rate_deviation = 0;                   ///< 1/s
  std::optional<Vector<2>> silhouette;               ///< px; centre of the area that the detector saw of it alone, in this frame
  std::vector<MeasurementLine> lines;                ///< of this frame; empty in a target's first
  State state = State::detected;
  std::vector<TrackId> behind;  ///< targets that hide a part of it in this frame, ascending
  std::vector<int> hidden;      ///< control points, ascending, whose edge is not seen: there the shape is as it was before
};

}  // namespace marey
