// How a camera that ought to stand has moved, from where places of the scene are seen. The camera pans, tilts and rolls about one
// point, and may creep forwards by a little: four numbers an image, whatever the lens is, which hold where nothing can be followed
// too (a sky, an empty lawn), unlike the eight of a free homography. A start is voted for by pairs of places, so that people who
// walk before most of the scene do not matter; then robust least squares (Geman & McClure's weights, the reach narrowing).
#pragma once

#include <optional>
#include <span>

#include "marey/core/geometry.h"

namespace marey::source::stabilise {

/// Against the camera at rest.
struct SceneMotion {
  Vector<3> turn = Vector<3>::Zero();  ///< rotation vector, rad, about the camera's right, down and ahead
  double log_scale = 0;                ///< ln of how much larger the scene is seen
};

/// A lens without distortion, px. Small turns through a lens with some are reported in docs/track.md.
struct PinholeView {
  double focal = 0;
  Vector<2> principal = Vector<2>::Zero();
};

/// The homography from pixels at rest to pixels of the moved camera.
Matrix<3> moved_from_rest(const SceneMotion& motion, const PinholeView& view);

/// What `motion` is against another rest, which itself is moved by `rest` from the one that both are reported against.
SceneMotion against(const SceneMotion& motion, const SceneMotion& rest);

/// `motion` against an image that itself is moved by `first`: both together, against the rest.
SceneMotion after(const SceneMotion& motion, const SceneMotion& first);

/// A place of the scene, px: at rest and now.
struct TrackedPosition {
  Vector<2> rest, detected;
};

struct SceneFit {
  SceneMotion motion;
  int agreeing = 0;   ///< places within `agree_px` of it
  double spread = 0;  ///< px: standard deviation of the agreeing places, along the axis where it is less
  double cost = 0;    ///< px², of all places, each at most agree_px²
};

/// What most places agree with; nothing of fewer than four. The same for the same places.
std::optional<SceneFit> fit_motion(std::span<const TrackedPosition> locations, const PinholeView& view, double agree_px);

}  // namespace marey::source::stabilise
