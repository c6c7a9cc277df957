// Where a person usually is among the others: a back stays behind and beside the middle of every person, a winger ahead and out, a
// keeper far behind. A person's places relative to that middle are taken for a normal distribution of unknown mean and covariance,
// of which only sums are kept; how well segments of paths fit together as one person's is the evidence for one such distribution
// behind them all (normal-inverse-Wishart, Gelman et al., "Bayesian Data Analysis", 3rd ed., §3.6). Places persist for some
// seconds, so a quarter of a minute counts as one. Assumes that roles last: one who changes position, or ends at half-time, seems
// like another person. Team colours, where a track has them, are counted likewise.
#pragma once

#include <array>

#include "marey/core/geometry.h"

namespace marey::track::ground {

/// The record of some segments of paths. Sums of segments are the segments together.
struct RoleSum {
  double count = 0;                       ///< of independent instants
  Vector<2> sum = Vector<2>::Zero();      ///< m, of places relative to the middle
  Matrix<2> squares = Matrix<2>::Zero();  ///< m²
  std::array<double, 2> teams{};          ///< instants at which it was of either team

  RoleSum& operator+=(const RoleSum& other);
  RoleSum& operator-=(const RoleSum& other);
  friend RoleSum operator+(RoleSum a, const RoleSum& b) { return a += b; }
  friend RoleSum operator-(RoleSum a, const RoleSum& b) { return a -= b; }
  /// A place that was held for this long, s; `team` is 0, 1, or −1 where it is not known.
  void add(const Vector<2>& relative, double seconds, int team);
};

/// Logarithm of the evidence that all of it is one person's; differences of it are what counts.
double log_evidence(const RoleSum& role);

}  // namespace marey::track::ground
