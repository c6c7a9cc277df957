// The turns after which a set of markers appears the same: from the points alone these poses cannot be distinguished.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/geometry/rigid.h"

namespace marey::solve::bodies {

/// A turn, other than none, under which each marker comes to lie where one is.
struct Symmetry {
  std::vector<int> onto;  ///< by marker: where which one is it comes to lie
  Rigid3 body_from_body;  ///< takes marker i to the place of `onto[i]`
  double worst = 0;       ///< m: the largest distance that is left
};

/// All of them: markers are exchanged where no distance between two changes by more than `tolerance` m, mirrored ones omitted.
/// A line of markers turns about itself without end; such layouts are refused elsewhere. At most `kMaxSymmetries`, as of a sphere
/// full of markers. Cost: by backtracking, next to nothing if distances differ.
std::vector<Symmetry> symmetries(std::span<const Vector<3>> layout, double tolerance);
inline constexpr std::size_t kMaxSymmetries = 120;

/// "turned 180° about its z axis": for people.
std::string words_of(const Symmetry& symmetry);

}  // namespace marey::solve::bodies
