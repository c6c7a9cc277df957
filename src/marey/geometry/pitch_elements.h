// The parts of a football pitch that people label in television images, by the names of SoccerNet's camera calibration: lines,
// arcs and the frames of the goals. Left and right are those of a camera on the near touchline, "top" is far from it and "bottom"
// near; the posts of a goal are left and right for who faces it from the pitch.
// Reference: Cioppa et al., "Scaling up SoccerNet with multi-view spatial localization and re-identification", Scientific Data
// 2022.
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <variant>
#include <vector>

#include "marey/geometry/pitch.h"
#include "marey/geometry/vector.h"

namespace marey::geometry {

/// m, in the pitch's frame: from the corner left and near, x to the right along the near touchline, y away, z up.
struct StraightElement {
  Vector<3> from = Vector<3>::Zero(), to = Vector<3>::Zero();
};

/// On the ground; from one angle to a larger one, rad, counted from the x axis towards y.
struct ArcElement {
  Vector<2> centre = Vector<2>::Zero();
  double radius = 0;
  double from = 0, to = 0;
};

struct PitchElement {
  std::string_view name;  ///< "Side line top", "Circle left", "Goal left post left " (with its blank): as in the files
  std::variant<StraightElement, ArcElement> shape;
};

inline constexpr int kPitchElements = 26;

/// All of them, always in the same order: an element is its index.
std::array<PitchElement, kPitchElements> pitch_elements(const PitchSize& size);

/// The index of that name; nothing if it does not exist.
std::optional<int> pitch_element_named(std::string_view name);

/// Which element has this one's place when the pitch is mirrored: left and right exchanged, near and far, or both, which is half
/// a turn.
struct PitchMirror {
  bool left_right = false, near_far = false;
};
int mirrored_element(int element, PitchMirror mirror);

/// One element as it was labelled in an image: points along its visible part, px.
struct LabelledElement {
  int element = 0;
  std::vector<Vector<2>> points;
};

/// Points along the element, both ends among them, `step` m apart or less.
std::vector<Vector<3>> sampled(const PitchElement& element, double step);

}  // namespace marey::geometry
