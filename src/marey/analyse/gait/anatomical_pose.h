// Segments from anatomical landmarks, as the ISB recommends (Wu et al. 2002 for pelvis, thigh and shank, 2005 for upper arm and
// forearm), with the axes of SegmentId: x ahead, y to the left, z up. Instead of the thorax' landmarks, which are not among them,
// the trunk goes up from the middle of the hips' centres to the middle of the shoulders, sideways along these. A foot is its sole:
// ahead from the heel to the middle of the toe's and the little toe's markers, sideways as the shank.
#pragma once

#include <array>
#include <span>
#include <string_view>

#include "marey/analyse/gait/conventional_model.h"

namespace marey::analyse::gait {

/// "left_asis", "right_hip_centre", …: what `anatomical_pose` uses, with a side before each.
std::span<const std::string_view> anatomical_landmarks();

/// Of the landmarks of one instant; a segment is absent if one of its own is.
GaitPose anatomical_pose(const MarkerPositions& landmarks);

}  // namespace marey::analyse::gait
