// Angles of joints, as the ISB recommends (Wu et al. 2002, 2005; Grood and Suntay 1983): first about the upper segment's sideways
// axis, then about the floating axis, then along the lower segment; of shoulders plane of elevation, elevation, axial rotation.
// Left and right are signed alike: flexion, adduction and internal rotation are positive, dorsiflexion too.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "marey/analyse/gait/conventional_model.h"

namespace marey::analyse::gait {

/// "left_knee_flexion", …, in the order of what `angles_of` gives.
std::span<const std::string> angle_names();

/// Radians, nothing if a segment is not known. `heading` is the direction of walking on the ground, of any length: pelvis and
/// trunk are reported against it.
std::vector<std::optional<double>> angles_of(const GaitPose& pose, const Vector<2>& heading);

/// Adds whole turns, so that no step is above half a turn; gaps are skipped.
void unwrap(std::span<std::optional<double>> angles);

}  // namespace marey::analyse::gait
