#pragma once

#include <span>
#include <string>
#include <vector>

#include "marey/core/rig.h"
#include "marey/track/ground/ground_contradictions.h"

namespace marey::pipeline::people::ground {

/// A sentence for each camera of the rig whose people are elsewhere than where the others that face there see them, and for each
/// other pair of cameras that contradict each other.
std::vector<std::string> contradicting_cameras(const Rig& rig, std::span<const track::ground::ComparedCameras> compared);

/// A sentence for each camera of several whose people no other camera sees: whether it agrees with them is unknown.
std::vector<std::string> uncompared_cameras(const Rig& rig, std::span<const track::ground::ComparedCameras> compared);

}  // namespace marey::pipeline::people::ground
