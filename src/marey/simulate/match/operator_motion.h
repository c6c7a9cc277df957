// How an operator of a main camera pans, tilts and zooms while a match is played.
//
// The operator follows the ball with a delay and smoothly, aims a little ahead towards the middle of the play, leaves small
// motions alone until the play has gone on by some degrees (so that there are still spans, broken by starts), keeps as much of the
// pitch in view as the play needs, and has a hand that trembles. Pan and tilt answer as a critically damped spring, zoom slower.
// Rates agree with a real operator's (330 frames of a television camera: pan to 15°/s, zoom to 20 % a second).
#pragma once

#include <cstdint>

#include "marey/core/geometry.h"
#include "marey/geometry/pitch.h"
#include "marey/geometry/tripod.h"
#include "marey/simulate/random.h"

namespace marey::simulate::match {

struct OperatorOptions {
  double answer = 2.2;     ///< rad/s: natural frequency of pan and tilt
  double zoom = 0.9;       ///< rad/s: of the zoom
  double patience = 0.05;  ///< rad: the play may be so far off the middle of the image before the operator follows
  double width = 38;       ///< m of the pitch that the image shows across, on average
  double tremble = 2e-4;   ///< rad, standard deviation, slower than 3 Hz
  double whips = 0;        ///< a second: how often the operator throws the camera to another part of the pitch, and back
};

class OperatorMotion {
 public:
  OperatorMotion(const geometry::Tripod& tripod, const geometry::PitchSize& pitch, const OperatorOptions& options,
                 std::uint64_t seed);

  /// Continues by `step` s, the ball at this place of the pitch, m. The first call starts there.
  geometry::Heading track_ball(const Vector<2>& ball, double step);

 private:
  struct Spring {
    double value = 0, speed = 0;
    void pull(double target, double frequency, double step);
  };
  geometry::Heading required(const Vector<2>& ball) const;
  void advance(const geometry::Heading& aim, double step);

  geometry::Tripod tripod_;
  geometry::PitchSize pitch_;
  OperatorOptions options_;
  Random random_;
  struct Whip {
    double left_s = 0, pan = 0;
  };
  Whip whip_;
  bool begun_ = false, tracking_ = false;
  double closeness_ = 0;  // ln of how much nearer than normal the operator shows the play
  Spring pan_, tilt_, log_focal_, shake_[2];
};

}  // namespace marey::simulate::match
