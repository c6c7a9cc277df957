// A pitch from above on a page: its grass, its lines, and what is drawn between them in metres.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "marey/core/appearance.h"
#include "marey/draw/pitch_frame.h"
#include "marey/draw/svg.h"

namespace marey::draw {

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
