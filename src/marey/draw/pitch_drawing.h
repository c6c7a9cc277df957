#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/core/image.h"
#include "marey/geometry/ground_view.h"
#include "marey/geometry/pitch.h"

namespace marey::draw {

/// A click on the pitch, in an image.
struct DrawnClick {
  Vector<2> pixel;
  bool fits = true;
  std::string name;
};

/// The pitch's lines (`lines` in the world, m) as the view shows them laid over its image, the paint that was found, and the
/// clicks: those that do not fit with their names. To check by eye whether a calibration is right.
Image draw_pitch(const Image& image, const GroundView& view, const std::vector<geometry::PitchLine>& lines,
                 const std::vector<Vector<2>>& paint, const std::vector<DrawnClick>& clicks);

/// A map of the pitch, SVG, coloured by `metres(x, y)`: how far a pixel's error reaches on the ground. Nothing is drawn where it
/// gives nothing. Coordinates are the pitch's own, x to the right, y downwards or not (core/ground_transform.h).
std::string pitch_map_svg(const std::string& title, const geometry::PitchSize& size, bool y_down,
                          const std::function<std::optional<double>(const Vector<2>&)>& metres);

}  // namespace marey::draw
