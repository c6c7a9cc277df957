#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/core/ground_views.h"
#include "marey/core/ids.h"
#include "marey/core/rig.h"
#include "marey/core/turning_camera.h"

namespace marey::pipeline::people {

/// How each camera of a rig is turned, in the rig's order; nothing for one that stands. Empty where all stand.
using TurningCameras = std::vector<std::shared_ptr<const TurningCamera>>;

/// That of a camera; nothing where it stands.
std::shared_ptr<const TurningCamera> turning_of(const TurningCameras& all, CameraId camera);

/// How a camera that turns sees the ground where it is first known. Throws Error, with its name, where it never is, or the size of
/// its pictures is not known.
GroundView first_view(const RigCamera& camera, const TurningCamera& turning, const geometry::GroundSurface& surface);

/// Tells the views how a camera is turned over time. While it is lost its view sees no ground, so that nobody has a place there.
void enter_turns(GroundViews& views, CameraId id, const RigCamera& camera, const TurningCamera& turning,
                 const geometry::GroundSurface& surface);

/// What of a place's covariance comes of how unsure it is where the camera looks; `time` by the rig's clock, `pixel` where the foot
/// is seen.
Matrix<2> aim_covariance(const RigCamera& camera, const TurningCamera& turning, Timestamp time, const Vector<2>& pixel);

}  // namespace marey::pipeline::people
