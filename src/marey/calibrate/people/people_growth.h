#pragma once

#include <cstdint>
#include <vector>

#include "marey/calibrate/incremental_rig.h"
#include "marey/calibrate/people/people_views.h"
#include "marey/core/rig.h"

namespace marey::calibrate::people {

/// The fewest points of one person at one time that link two cameras.
inline constexpr int kMinShared = 40;  // unswept

/// By how much a stated focal length may be wrong: cropped and stabilised videos have a longer one.
inline constexpr double kStatedFocal = 0.1;  // physical: relative, of videos that are cropped or stabilised

/// Static cameras roughly right, by some of the points, for the focal length of several that explains them best where lenses are
/// not known. Throws Error, with the cause and what to do, if a camera shares too few points with any other, or no geometry is
/// found; Stopped.
Growth grow_by_people(const PeopleViews& views, const Rig& rig, const std::vector<PointRow>& rows, std::uint64_t seed);

}  // namespace marey::calibrate::people
