#pragma once

#include <span>

#include <opencv2/core.hpp>

#include "marey/detect/background/background_plane.h"
#include "marey/detect/background/background_shadow.h"

namespace marey::detect::background {

/// The planes of a scene that was begun with `samples`; the chroma's are null where the images are grey.
struct ScenePlanes {
  ScenePlane* luma;
  ScenePlane* cb;
  ScenePlane* cr;
};

/// Corrects a scene that was begun with the most frequent levels of `samples`, which are in the order of time and of one size:
/// where none of the levels was there most of the time, the scene is what came back after a temporary other. A person who stands
/// at a place for a third of the time, and longer than it was seen empty, is not the scene.
void trust_what_returns(std::span<const FramePlanes> samples, const ScenePlanes& scene);

}  // namespace marey::detect::background
