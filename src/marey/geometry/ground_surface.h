// The ground's height above the plane z = 0 of the world: level, or crowned as pitches are so that rain runs off.
//
// With u and v the distance from the pitch's middle along and across it, in half lengths and half widths, and p(t) the profile, 0
// in the middle and 1 at the lines,
//
//   z = across (1 − p(v)) + along (1 − p(u)) + dome (1 − p(u)) (1 − p(v)):
//
// the corners lie on z = 0. `ridge` leads p from the parabola t² (0) to a roof with a rounded ridge (1). A hip roof, "envelope" to
// groundsmen, is nearly a dome. Beyond the lines the ground falls on for a fifth of its half size and is level from there.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "marey/geometry/vector.h"

namespace marey::geometry {

struct GroundSurface {
  static constexpr int kTerms = 4;        ///< across, along, dome, ridge
  static constexpr double kMaxLevel = 2;  ///< m, that any height may be: more is a hill, and rays may meet it twice

  Vector<2> middle = Vector<2>::Zero();    ///< m, in the world
  Vector<2> half = Vector<2>(52.5, 34);    ///< m, from the middle to the lines along x and along y; positive
  double across = 0, along = 0, dome = 0;  ///< m
  double ridge = 0;                        ///< in [0, 1]

  bool flat() const { return across == 0 && along == 0 && dome == 0; }

  /// m above z = 0.
  double height(const Vector<2>& location) const;
  /// ∂height/∂place.
  Vector<2> slope(const Vector<2>& location) const;

  std::array<double, kTerms> terms() const { return {across, along, dome, ridge}; }
  void set_terms(const std::array<double, kTerms>& t) { across = t[0], along = t[1], dome = t[2], ridge = t[3]; }

  /// Place from the middle, in half sizes, held where the ground is level again.
  Vector<2> relative(const Vector<2>& location) const {
    return (location - middle).cwiseQuotient(half).cwiseMax(-kMaxDistance).cwiseMin(kMaxDistance);
  }
  /// Height at `relative`, of any terms: a solver differentiates by them.
  template <typename T>
  static T height_at(const Vector<2>& relative, const T* terms) {
    const T u = T(1) - profile(relative.x(), terms[3]), v = T(1) - profile(relative.y(), terms[3]);
    return terms[0] * v + terms[1] * u + terms[2] * u * v;
  }

 private:
  static constexpr double kMaxDistance = 1.2;  // half sizes, up to which the ground falls
  static constexpr double kRound = 0.1;        // half sizes: how rounded a ridge is

  static double roof(double t) { return (std::sqrt(t * t + kRound * kRound) - kRound) / (std::sqrt(1 + kRound * kRound) - kRound); }
  template <typename T>
  static T profile(double t, const T& ridge) {
    return T(t * t) + ridge * T(roof(t) - t * t);
  }
};

}  // namespace marey::geometry
