// How a body turned while it was hidden: predicted by its own turning rate before and after, and by each other body that may carry
// it, as a hand does. How far each prediction is off is measured where the body was seen, over intervals as long as the gap: so a
// hand that holds a racket is found without being named, and one that drops it is trusted no more.
#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/core/time.h"

namespace marey::solve::bodies {

/// An instant at which the body was seen.
struct ObservedRotation {
  Timestamp time{};
  Matrix<3> rotation = Matrix<3>::Identity();    ///< world from body
  Vector<3> rate = Vector<3>::Zero();            ///< rad/s, about the world's axes
  std::vector<std::optional<Matrix<3>>> others;  ///< of all bodies, where they were seen; its own is not read
};

/// Where a body is due, and what that may be off by.
struct DueRotation {
  Matrix<3> rotation = Matrix<3>::Identity();
  double variance = 0;  ///< rad², about each axis
};

class HiddenRotation {
 public:
  /// `angular_acceleration`: rad/s², what a body's own turning may change by before that is measured.
  HiddenRotation(std::size_t bodies, double angular_acceleration);

  /// Instants in growing order of time, while the body is seen without a gap.
  void add(ObservedRotation seen);
  /// It was hidden: what comes next is not held against what came before.
  void interrupt() { observed_.clear(); }

  /// Where it is due at `after`, whose rotation is not read: by the predictor that was off least over such a time.
  DueRotation due(const ObservedRotation& before, const ObservedRotation& after) const;

 private:
  static constexpr std::array kIntervals_s{0.1, 0.2, 0.4, 0.8, 1.6};  // numerical: doubled, up to what is remembered

  /// Squared errors of one predictor, by interval.
  struct Errors {
    std::array<double, kIntervals_s.size()> squares{}, count{};
  };

  double own_variance(double hidden_s) const;
  std::optional<double> carried_variance(const Errors& errors, double hidden_s) const;

  double rate_noise_;  // rad²/s³
  Errors own_;
  std::vector<Errors> carried_;  // by body
  std::deque<ObservedRotation> observed_;
};

}  // namespace marey::solve::bodies
