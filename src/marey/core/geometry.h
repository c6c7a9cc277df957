#pragma once

#include "marey/geometry/box.h"
#include "marey/geometry/vector.h"

namespace marey::geometry {
class Camera;
class GroundView;
struct Ray;
struct Rigid3;
}  // namespace marey::geometry

namespace marey {

/// The words of geometry that every room uses. A file that needs more of a camera than its name includes its header.
using geometry::Box;
using geometry::Camera;
using geometry::GroundView;
using geometry::Matrix;
using geometry::Ray;
using geometry::Rigid3;
using geometry::Vector;

}  // namespace marey
