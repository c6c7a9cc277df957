// By how much the bottom of each person's box errs for a while, as one camera sees it.
//
// A detector's box does not end at the foot by chance alone: gait, posture, shadow and the habit of the detector make it end before
// or behind it for many frames, differently in each camera. The error on the ground is the sum of two first-order autoregressive
// processes per axis, a slow one and a quick one; its autocorrelation at 25 Hz is .77, .42, .23 and .08 after 1, 5, 12 and 25
// frames, close to what boxes of a recorded match show against its truth.
#pragma once

#include <array>
#include <cstdint>

#include "marey/core/geometry.h"
#include "marey/simulate/match/match_motion.h"
#include "marey/simulate/random.h"

namespace marey::simulate::match {

class FootErrors {
 public:
  static constexpr double kSlowFraction = 0.6;             ///< of the variance
  static constexpr double kSlow_s = 0.5, kQuick_s = 0.06;  ///< time constants

  /// `sigma`: standard deviation per axis, m. Errors are stationary from the beginning on.
  FootErrors(double sigma, std::uint64_t seed);

  /// Continues by `dt` s, positive.
  void advance(double dt);

  /// m on the ground, of person 0 … kMatchPeople − 1.
  Vector<2> of(int person) const { return slow_[static_cast<std::size_t>(person)] + quick_[static_cast<std::size_t>(person)]; }

  /// The covariance per axis of the errors at two instants `lag` s apart, m².
  static double covariance(double sigma, double lag);

 private:
  using Errors = std::array<Vector<2>, kMatchPeople>;

  void renew(Errors& errors, double kept, double sigma);

  double sigma_;
  Random random_;
  Errors slow_{}, quick_{};
};

}  // namespace marey::simulate::match
