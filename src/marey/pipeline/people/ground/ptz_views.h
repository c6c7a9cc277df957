#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/core/ground_views.h"
#include "marey/core/ids.h"
#include "marey/core/ptz_camera.h"
#include "marey/core/rig.h"

namespace marey::pipeline::people::ground {

/// How each camera of a rig is turned, in the rig's order; nothing for one that stands. Empty if all stand.
using PtzCameras = std::vector<std::shared_ptr<const PtzCamera>>;

/// That of a camera; nothing if it stands.
std::shared_ptr<const PtzCamera> ptz_of(const PtzCameras& all, CameraId camera);

/// How a PTZ camera sees the ground where it is first known. Throws Error, with its name, where it never is, or the size of
/// its images is not known.
GroundView first_view(const RigCamera& camera, const PtzCamera& ptz, const geometry::GroundSurface& surface);

/// Gives the views a camera's orientation over time. While it is lost its view sees no ground, so that no person has a place there.
void enter_ptz(GroundViews& views, CameraId id, const RigCamera& camera, const PtzCamera& ptz,
               const geometry::GroundSurface& surface);

/// Where a camera is aimed at a time, by the rig's clock; nothing if that is not known.
std::optional<geometry::Heading> heading_at(const RigCamera& camera, const PtzCamera& ptz, Timestamp time);

/// The part of a place's covariance from the uncertainty of the camera's aim; `time` by the rig's clock, `pixel` where the
/// foot is seen.
Matrix<2> aim_covariance(const RigCamera& camera, const PtzCamera& ptz, Timestamp time, const Vector<2>& pixel);

}  // namespace marey::pipeline::people::ground
