// A pitch from above on a page: its grass, its lines, and what is drawn between them in metres.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "marey/core/appearance.h"
#include "marey/draw/svg.h"
#include "marey/geometry/pitch.h"

namespace marey::draw {

/// Where a pitch is in the coordinates of what is drawn on it.
struct PitchFrame {
  geometry::PitchSize size = {};
  Vector<2> corner = Vector<2>::Zero();  ///< m: its own with the least x and y
  bool y_down = false;                   ///< else y grows upwards; see core/other_ground.h
};

class PitchSvg {
 public:
  explicit PitchSvg(const PitchFrame& frame);

  /// What is drawn here is in m, in the frame's coordinates. No texts: they would be turned over.
  SvgElement& field() { return *field_; }
  /// With the lines over what was drawn. They are those of `lines_html`, which stands once in the page.
  std::string html();
  static std::string lines_html(const PitchFrame& frame);

 private:
  Svg svg_;
  std::optional<SvgElement> field_;
};

/// A team's colour on the grass, in CSS: as bright as it must be to be seen there, white and black as such, whatever shade video
/// shows them in.
std::string colour_on_grass(const Appearance& shirt);

}  // namespace marey::draw
