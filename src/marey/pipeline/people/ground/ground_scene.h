// How a rig's cameras see the ground, and which part of it counts: what the stages of people on the ground share.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "marey/core/geometry.h"
#include "marey/core/ground_views.h"
#include "marey/core/ids.h"
#include "marey/core/rig.h"
#include "marey/core/time.h"
#include "marey/reconstruct/ground_area.h"

namespace marey::pipeline::people::ground {

struct GroundScene {
  Rig rig;  ///< its cameras as their feeds are
  std::shared_ptr<GroundViews> views;
  reconstruct::GroundArea area;
  /// The box, px, of a person at a position (m, world) in a camera's image at this time, by the rig's clock; nothing if unknown.
  std::function<std::optional<Box>(CameraId camera, const Vector<2>& position, Timestamp time)> box_at;

  /// Whether a position (m, world) is within the area and within some camera's image at this time, by the rig's clock.
  bool in_view(const Vector<2>& position, Timestamp time) const;
};

}  // namespace marey::pipeline::people::ground
