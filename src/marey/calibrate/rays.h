#pragma once

#include <optional>
#include <span>

#include "marey/core/geometry.h"
#include "marey/geometry/camera.h"

namespace marey::calibrate {

/// A ray and how far, rad, it may be off.
struct SightLine {
  Ray ray;
  double sigma = 1e-3;
};

/// The point nearest to all lines by the squares of their angles; nothing if fewer than two lines are given, they are parallel,
/// or the point lies behind one of them.
std::optional<Vector<3>> intersection_point(std::span<const SightLine> lines);

/// Angle between a line and the direction from its origin to `point`, in its sigmas.
double angle_off(const SightLine& line, const Vector<3>& point);

/// The point that most lines agree on within `gate` sigmas, two at least; where not all agree every two of them propose one.
std::optional<Vector<3>> agreed_point(std::span<const SightLine> lines, double gate);

}  // namespace marey::calibrate
