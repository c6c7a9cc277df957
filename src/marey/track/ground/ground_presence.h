#pragma once

#include <cmath>

namespace marey::track::ground {

/// Whether there is a person, as probabilities instead of as hypotheses of their own: a person is there and can be seen, or is
/// there and hidden from all for a reason that is not known, or is not there: a false alarm, or gone. The three are summed over
/// exactly, step by step (Musicki, Evans & Stankovic, "Integrated probabilistic data association", IEEE Trans. AC 39 (1994), with
/// the state `hidden` added: a person missed in one frame is likely to be missed in the next), which spares a hypothesis for each
/// case in which an observation may be false, and a miss may be a farewell.
class GroundPresence {
 public:
  /// An observation that nothing known explains: `births` and `clutter` are the densities of people who appear and of false alarms.
  GroundPresence(double births, double clutter) : visible_(births / (births + clutter)) {}

  /// `dt` ≥ 0 seconds pass.
  void predict(double dt) {
    const double stays = std::exp(-dt / stay);
    const double hides = visible_ * -std::expm1(-dt / between_hidings);
    const double shows = hidden_ * -std::expm1(-dt / hiding);
    visible_ = (visible_ - hides + shows) * stays;
    hidden_ = (hidden_ + hides - shows) * stays;
  }

  /// That there is a person who can be seen.
  double visible() const { return visible_; }

  void observe_frame() {
    visible_ = 1;
    hidden_ = 0;
  }

  /// It was not seen where it would have been with probability `detected`, were it visible.
  void miss(double detected) {
    const double likelihood = 1 - visible_ * detected;
    visible_ *= (1 - detected) / likelihood;
    hidden_ /= likelihood;
  }

 private:
  static constexpr double stay = 60;             // s, mean: people leave within a minute
  static constexpr double between_hidings = 10;  // s, mean
  static constexpr double hiding = 1;            // s, mean

  double visible_;
  double hidden_ = 0;
};

}  // namespace marey::track::ground
