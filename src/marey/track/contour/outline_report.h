#pragma once

#include <memory>
#include <optional>

#include <opencv2/core.hpp>

#include "marey/core/detection.h"
#include "marey/core/track.h"
#include "marey/geometry/bspline.h"
#include "marey/track/contour/contour_target.h"

namespace marey::track::contour {

/// Where the outline left the tracker's box, or is cut off or larger than a body in it, the tracker is right: the last shape that
/// filled the box is held in it, with all of its edge hidden. `raw` is the detection that the tracker used; null: none.
void bring_back(ContourTarget& target, const Track<2>& track, const Detection* raw);

/// The target's outline as it is written; nothing if the contour is not an outline of a target of this size. `seen` is the
/// silhouette of one target alone, if any; `picture` its frame's size, px, empty if that is not known.
std::shared_ptr<const Outline> report(ContourTarget& target, const Detection* detected, const Track<2>& track,
                                      const cv::Size& image);

}  // namespace marey::track::contour
