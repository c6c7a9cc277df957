#pragma once

#include <string>
#include <vector>

#include "marey/geometry/vector.h"

namespace marey::geometry {

/// The white lines of a football pitch by the Laws of the Game, in m. x runs along the touchlines, y along the goal lines, both
/// from one corner; which side of the pitch y = 0 is, is the user's affair. Length and width are the pitch's own, the rest is
/// fixed.
struct PitchSize {
  double length = 105;
  double width = 68;
};

/// One straight line or arc, sampled evenly.
struct PitchLine {
  std::string name;                 ///< "halfway line", "penalty area left, front", …
  std::vector<Vector<2>> points;    ///< m, in order along the line
  std::vector<Vector<2>> tangents;  ///< length 1, at each point
};

inline constexpr double kPitchLineWidth = 0.12;  ///< m, at most, by the Laws

/// Every line, a point each `step` m or less.
std::vector<PitchLine> pitch_lines(const PitchSize& size, double step);

/// m from a place on the ground to the middle of the nearest line.
double distance_to_line(const PitchSize& size, const Vector<2>& location);

}  // namespace marey::geometry
