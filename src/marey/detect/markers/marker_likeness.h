#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "marey/detect/markers/marker_contrast.h"
#include "marey/detect/markers/marker_fit.h"
#include "marey/geometry/median.h"

namespace marey::detect::markers {

/// What the markers of a recording are like, learned most from those that are plainly discs: markers of one recording are of one
/// kind, or of a small and a large one (dust beside spheres, a face beside a body). Nothing is known, and nothing unlike, before
/// the first of them.
class MarkerLikeness {
 public:
  /// `widest`: px, of what the user says of markers; 0 where that is nothing.
  explicit MarkerLikeness(double widest) : stated_radius_(widest / 2) {}

  /// What one blob says.
  struct Witness {
    double radius = 0;           ///< px
    std::optional<double> blur;  ///< px
    double announce = 0;         ///< how much it counts
    double contrast = 0;         ///< grey levels
    bool round = false;          ///< whether it may support a large kind
  };

  /// Takes in the observations of a frame.
  void learn(std::span<const Witness> detected);

  std::optional<double> blur() const { return blur_; }  ///< px
  std::optional<double> widest() const;                 ///< px, so that twice the radius and the blurred edge are within

  /// No marker, whether alone, drawn out by its motion or with others that touch it, covers this many px².
  bool too_large(double area) const;
  /// A marker that is not a disc (half hidden, shaded, of a shape that nothing explains) covers no more than this many px².
  bool odd(double area) const;
  /// A disc of this radius, or a streak so wide, may be one of them; or one of three and more in a blob, which a half hidden marker
  /// looks like too where they may be small.
  bool fits(double radius, std::size_t together = 1) const;
  /// Light that falls off slowly round a core of this radius is a lamp's, not a marker's out of focus.
  bool lamp(double radius) const { return radius_ && radius > kLampRadius * largest(); }
  /// Its edge is as sharp as theirs, or nearly.
  bool sharp(double blur) const;

 private:
  static constexpr double kLampRadius = 1.5;  // times a marker's

  std::optional<double> large_kind(std::span<const Witness> detected);
  double area(double markers) const;
  double largest() const { return std::max(*radius_, large_.value_or(0)); }

  double stated_radius_;
  std::optional<double> radius_, blur_;
  std::optional<double> large_;  ///< px, the radius of the large kind where there are two
  std::vector<geometry::WeightedValue> radii_, blurs_, contrasts_;
};

}  // namespace marey::detect::markers
