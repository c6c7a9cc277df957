#pragma once

#include <memory>

#include <opencv2/core.hpp>

#include "marey/core/detection.h"
#include "marey/core/track.h"
#include "marey/track/contour/contour_target.h"

namespace marey::track::contour {

/// Where the motion left the tracker's box, the tracker is right: the outline is moved there with its shape held.
void bring_back(ContourTarget& target, const Track<2>& track);

/// The target's outline as it is written; nothing if the contour is not an outline of a target of this size. `seen` is the
/// silhouette that no person shares, if any; `picture` its frame's size, px, empty if that is not known.
std::shared_ptr<const Outline> report(ContourTarget& target, const Detection* detected, const Track<2>& track,
                                      const cv::Size& image);

}  // namespace marey::track::contour
