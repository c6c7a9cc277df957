#pragma once

#include "marey/core/geometry.h"

namespace marey::track::contour {

/// Lengths in px.
struct MotionNoise {
  double acceleration = 0;  ///< velocity strays by this each √second, px/s^1.5
  double growth = 0;        ///< the rate of growth strays by this each √second, 1/s^1.5
};

/// The motion filter: the centre of an outline, its velocity, and the rate s at which it grows; both assumed to stay as they are.
class MotionFilter {
 public:
  /// Begins with standard deviations in px, px/s and 1/s.
  MotionFilter(const Vector<2>& centre, const Vector<2>& velocity, double growth, double centre_deviation,
               double velocity_deviation, double growth_deviation);

  void predict(double dt, const MotionNoise& noise);

  /// The corrected outline's centre, with standard deviations per axis, px.
  void correct_centre(const Vector<2>& measured, const Vector<2>& deviation);
  /// The rate of growth read off the corrected outline, 1/s.
  void correct_growth(double measured, double deviation);

  const Vector<2>& centre() const { return centre_; }      ///< px
  const Vector<2>& velocity() const { return velocity_; }  ///< px/s
  double growth() const { return growth_; }                ///< 1/s
  Vector<2> centre_deviation() const;
  Vector<2> velocity_deviation() const;
  double growth_deviation() const;

 private:
  Vector<2> centre_, velocity_;
  double growth_;
  Vector<2> Pcc_, Pcv_, Pvv_;  // axis by axis: the axes do not mix
  double Pss_;
};

}  // namespace marey::track::contour
