#pragma once

#include <span>

#include "marey/core/image.h"
#include "marey/track/contour/colour/body_mask.h"
#include "marey/track/contour/colour/scene_image.h"
#include "marey/track/contour/contour_target.h"

namespace marey::track::contour {

/// A target that shares its pixels with others, and where the tracker has it.
struct SharedTarget {
  ContourTarget* target = nullptr;
  Box box;                                 ///< px
  bool observed = false;                   ///< the tracker saw something of it in this frame
  const colour::BodyMask* mask = nullptr;  ///< a network's of it in this frame; null: none was asked
};

/// Divides the region that `targets` share among them by their colours and predicted shapes, and gives each the outline of its own
/// part, the rest of it shaped as it was; if too little of a target is seen, its whole shape is kept. `mask` is CV_8UC1.
/// `scene` may be null.
void outline_shared_region(const Image& image, const cv::Mat& mask, const colour::SceneImage* scene,
                           std::span<SharedTarget> targets);

}  // namespace marey::track::contour
