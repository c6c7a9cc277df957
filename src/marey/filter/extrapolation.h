#pragma once

// Extrapolation from the last three positions: the parabola through them, in each coordinate, is followed on.
//
// Source: Figueroa, Leite, Barros, "A flexible software for tracking of markers used in human motion analysis", Computer
// Methods and Programs in Biomedicine 72, 2003: the next place is a function of the places in the three frames before, its
// parameters found by experiment. Here the parameter is the share of the bend that is kept: 1 is the parabola
// (3 a − 3 b + c for even steps), 0 the straight line through the last two places. Uneven steps: Newton's divided differences.
// Nothing is smoothed, so the noise of one place is felt three times over; there is no state to be wrong after a sharp turn.
// Before there are three places, the line through two is used, and rest before there are two.
// Cost: 10 D multiplications a step.

#include <array>
#include <cmath>

#include "marey/core/geometry.h"

namespace marey::filter {

template <int D>
class Extrapolation;

/// Lengths in px where the filter runs in the image, in m on the ground and in space.
struct ExtrapolationOptions {
  double bend = 1.0;          ///< share of the parabola's bend that is kept, in [0, 1]
  double search_radius = 40;  ///< px or m

  template <int D>
  using Model = Extrapolation<D>;

  /// The same filter where one unit of length is `factor` of the new ones.
  ExtrapolationOptions scaled(double factor) const { return {bend, search_radius * factor}; }
};

template <int D>
class Extrapolation {
 public:
  using Options = ExtrapolationOptions;
  static constexpr int dimension = D;
  static constexpr bool unsmoothed = true;

  Extrapolation(const Options& options, const Vector<D>& z, const Matrix<D>& R) : options_(options) { locations_[0] = {z, R, 0}; }

  void predict(double dt) { ahead_ += dt; }

  /// Where no time went by since the last measurement, the new one takes its place.
  void correct(const Vector<D>& z, const Matrix<D>& R) {
    if (ahead_ > 0) {
      locations_[2] = locations_[1];
      locations_[1] = locations_[0];
      locations_[0].step = ahead_;
      known_ = std::min(known_ + 1, 3);
    }
    locations_[0].z = z;
    locations_[0].R = R;
    ahead_ = 0;
  }

  Vector<D> position() const {
    const auto w = weights();
    return w[0] * locations_[0].z + w[1] * locations_[1].z + w[2] * locations_[2].z;
  }

  /// The slope of the curve at the present.
  Vector<D> velocity() const {
    Vector<D> slope = Vector<D>::Zero();
    if (known_ < 2) return slope;
    slope = difference(0);
    if (known_ == 3) slope += (2 * ahead_ + locations_[0].step) * bend();
    return slope;
  }

  /// What the places' own noise makes of the extrapolated one; that the curve may be the wrong one is not in it.
  Matrix<D> covariance() const {
    const auto w = weights();
    return w[0] * w[0] * locations_[0].R + w[1] * w[1] * locations_[1].R + w[2] * w[2] * locations_[2].R;
  }
  Matrix<D> innovation_covariance(const Matrix<D>& R) const { return covariance() + R; }

  /// The search area is a circle (a ball) of fixed radius.
  double gate_distance(const Vector<D>& z, const Matrix<D>& /*R*/) const {
    return (z - position()).norm() / options_.search_radius;
  }

 private:
  struct Location {
    Vector<D> z = Vector<D>::Zero();
    Matrix<D> R = Matrix<D>::Zero();
    double step = 0;  // s since the place before
  };

  Vector<D> difference(std::size_t i) const { return (locations_[i].z - locations_[i + 1].z) / locations_[i].step; }
  Vector<D> bend() const { return (options_.bend / (locations_[0].step + locations_[1].step)) * (difference(0) - difference(1)); }

  /// The extrapolated place as a weighted sum of the known ones, the latest first.
  std::array<double, 3> weights() const {
    if (known_ < 2 || ahead_ == 0) return {1, 0, 0};
    const double line = ahead_ / locations_[0].step;
    std::array<double, 3> w = {1 + line, -line, 0};
    if (known_ == 3) {
      const double h0 = locations_[0].step;
      const double h1 = locations_[1].step;
      const double arc = options_.bend * ahead_ * (ahead_ + h0) / (h0 + h1);
      w[0] += arc / h0;
      w[1] -= arc / h0 + arc / h1;
      w[2] = arc / h1;
    }
    return w;
  }

  Options options_;
  std::array<Location, 3> locations_;  // the latest first
  int known_ = 1;
  double ahead_ = 0;  // s since the latest
};

}  // namespace marey::filter
