#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "marey/core/labelled_box.h"
#include "marey/core/rig.h"
#include "marey/simulate/match/match_motion.h"
#include "marey/simulate/people/figure.h"
#include "marey/simulate/people/people_renderer.h"
#include "marey/simulate/random.h"

namespace marey::simulate::match {

/// Where a point is seen by a view's camera, which must be whole, as in all of these; nothing if it cannot be. Its height counts
/// from the ground below it: what stands on a crowned pitch is raised with it.
std::optional<people::Sighting> sight(const GroundView& view, const Vector<3>& point);

/// How each person of a match is built and dressed: white and blue sides, keepers and referees in colours of their own.
std::array<people::Figure, kMatchPeople> match_figures(std::uint64_t seed);

/// How a person stands in the world. `world_from_pitch` turns the pitch's x and y into the world's, a reflection perhaps.
people::Stance match_stance(const MatchPerson& person, const Matrix<3>& world_from_pitch);

/// A person as one camera sees it.
struct ObservedPerson {
  int person = 0;               ///< 0 … kMatchPeople − 1
  Box whole;                    ///< px; round the figure, hidden parts and what lies outside the image included
  Box shown;                    ///< `whole` cut at the image's border
  double visible_fraction = 0;  ///< of the box `whole`: within the image and not behind boxes of nearer people
};

/// Each person who is partly within the image, in the order of their numbers.
std::vector<ObservedPerson> people_in_view(const GroundView& view, std::span<const people::Figure, kMatchPeople> figures,
                                           std::span<const people::Stance, kMatchPeople> stances);

/// A person with a smaller visible part is barely ever detected.
inline constexpr double kHiddenFraction = 0.35;

/// How a detector errs, from frame to frame independently but for `foot_error`.
struct MatchDetectorOptions {
  double missed = 0.1;         ///< share of people in plain view that are not detected, in [0, 1]
  double size_noise = 0.05;    ///< standard deviation of widths and heights, as a share of them; each edge errs on its own
  double false_alarms = 0.5;   ///< a frame, on average; boxes where there is no person
  double hidden_found = 0.05;  ///< of people who are hidden, the share that is detected all the same
  double foot_error = 0;       ///< m on the ground, standard deviation per axis, by which boxes end beside the feet for a while
                               ///< (foot_errors.h); unlike the rest it is not a frame's own
  double foot_along = 0.5;  ///< share of its variance along the view, in [0, 1]: a box that ends too low or high errs there alone
};

/// `seen` as if each had stood `by` m from its `place`, both in the world: the bottom of its box and its sides move, its top stays.
/// A box that the image's border cuts at the bottom keeps that.
ObservedPerson with_foot_moved(const ObservedPerson& detected, const GroundView& view, const Vector<2>& location,
                               const Vector<2>& by);

/// What such a detector says of one frame, from left to right; `margin` m round the pitch is where it sees people who are not
/// there.
std::vector<LabelledBox> detect_match(std::span<const ObservedPerson> detected, const GroundView& view,
                                      const Matrix<3>& world_from_pitch, const geometry::PitchSize& pitch, std::int32_t frame,
                                      const MatchDetectorOptions& options, Random& random);

}  // namespace marey::simulate::match
