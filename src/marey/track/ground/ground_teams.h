// Two teams in two shirts, as evidence of who is who.
//
// What two colours say of one person depends on the recording: where a camera gives everything a cast of blue, white and blue
// shirts have one hue and differ by a few units only, and yet every person is plainly of one or the other. So the two shirts are
// learned from all that was seen: two means with one covariance about them, in plain L*a*b*, those unlike either omitted (keepers,
// referees). Where they do not stand far apart, or one is rare, there are no teams, and nothing is said. Cost: some passes over the
// colours.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "marey/core/appearance.h"
#include "marey/core/geometry.h"

namespace marey::track::ground {

class GroundTeams {
 public:
  /// From the observations of every person, some hundreds of colours and more. Nothing if they are not of two kinds.
  static std::optional<GroundTeams> learn(std::span<const Appearance> detected);

  /// Logarithm of how much likelier one of the second team is seen in this colour than one of the first; near 0 where it is
  /// neither's.
  double log_odds(const Appearance& colour) const;

  /// Logarithm of how much likelier a person known by the one colour is seen in the other than any person is: at most log 2, which
  /// teams of equal number allow, and barely less than −3: a single observation may show another person.
  double same(const Appearance& known, const Appearance& detected) const;

  /// The same of two colours that were seen for a while each: barely less than −6.
  double same_for_long(const Appearance& known, const Appearance& detected) const;

  /// Between the means, in deviations of one shirt's colour.
  double apart() const { return apart_; }

 private:
  double agreement(const Appearance& known, const Appearance& detected, double anybody) const;
  double log_odds(const Appearance& colour, double anybody) const;
  double likelihood(const Vector<3>& colour, double variance, int team) const;

  std::array<Vector<3>, 2> means_;
  Matrix<3> precision_ = Matrix<3>::Identity();
  double apart_ = 0;
};

}  // namespace marey::track::ground
