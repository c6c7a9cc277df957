#pragma once

#include <memory>

#include <opencv2/core.hpp>

#include "marey/core/detection.h"
#include "marey/core/track.h"
#include "marey/track/contour/followed_target.h"

namespace marey::track::contour {

/// Where the motion left the tracker's box, the tracker is right: the outline is moved there with its shape held.
void bring_back(FollowedTarget& target, const Track<2>& track);

/// The target's outline as it is written; nothing where what is known is no outline of a target of this size. `seen` is the
/// silhouette that nobody shares, if any; `picture` its frame's size, px, empty where that is not known.
std::shared_ptr<const Outline> report(FollowedTarget& target, const Detection* seen, const Track<2>& track,
                                      const cv::Size& picture);

}  // namespace marey::track::contour
