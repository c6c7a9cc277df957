#pragma once

#include <vector>

#include "marey/core/geometry.h"
#include "marey/geometry/pitch.h"
#include "marey/simulate/people/people_renderer.h"

namespace marey::simulate::match {

/// A point of the pitch, in the world.
Vector<2> in_world(const Matrix<3>& world_from_pitch, const Vector<2>& at);

/// The posts of both goals, in the world.
std::vector<people::Post> goal_posts(const Matrix<3>& world_from_pitch, const geometry::PitchSize& pitch);

}  // namespace marey::simulate::match
