#pragma once

#include <cstdint>

#include "marey/core/geometry.h"
#include "marey/core/image.h"
#include "marey/geometry/ground_view.h"
#include "marey/geometry/pitch.h"

namespace marey::simulate::match {

/// The empty scene of a match as the whole camera of `view` sees it, colour: a mown pitch with its white lines, grass round it,
/// boards, trees and sky. `pitch_from_world` turns the world's ground (x, y, 1) into the pitch's own.
Image draw_match_ground(const GroundView& view, const Matrix<3>& pitch_from_world, const geometry::PitchSize& pitch,
                        std::uint64_t seed);

}  // namespace marey::simulate::match
