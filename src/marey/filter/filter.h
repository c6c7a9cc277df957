#pragma once

#include <concepts>

#include "marey/core/geometry.h"

namespace marey::filter {

/// One target's state over time. A model of Filter is a value type for one dimension D:
///
///   typename F::Options          its parameters, in physical units, with defaults; Options::Model<D> is F, and
///   options.scaled(factor)       the same for a unit of length that is 1 / factor of this one (people: body heights → px)
///   F::dimension                 D, 2 or 3
///   F(options, z, R)             begins at a first measurement z (px or m) with covariance R, at rest
///   f.predict(dt)                moves the state dt ≥ 0 seconds ahead
///   f.correct(z, R)              takes in a measurement of the position
///   f.position(), f.velocity()   px or m, and per second
///   f.covariance()               of the position
///   f.innovation_covariance(R)   S: how far a measurement with covariance R is expected to lie from position()
///   f.gate_distance(z, R)        where z lies in the search area that the method defines: 0 at its centre, 1 on its border
///
/// Invariants, tested for every model by filter/filter_invariants.h: predict(0) changes nothing; a measurement that lies at
/// position() does not move it (where position() is the mean of a mixture, by no more than a part of its spread); covariances stay
/// symmetric and positive; a target that moves as the model assumes is followed without bias; nothing becomes NaN for any finite
/// input.
template <typename F>
concept Filter = requires(F filter, const F constant, const typename F::Options options, double dt, const Vector<F::dimension>& z,
                          const Matrix<F::dimension>& R) {
  F(options, z, R);
  filter.predict(dt);
  filter.correct(z, R);
  { constant.position() } -> std::convertible_to<Vector<F::dimension>>;
  { constant.velocity() } -> std::convertible_to<Vector<F::dimension>>;
  { constant.covariance() } -> std::convertible_to<Matrix<F::dimension>>;
  { constant.innovation_covariance(R) } -> std::convertible_to<Matrix<F::dimension>>;
  { constant.gate_distance(z, R) } -> std::convertible_to<double>;
  { options.scaled(dt) } -> std::same_as<typename F::Options>;
  requires std::same_as<typename F::Options::template Model<F::dimension>, F>;
};

}  // namespace marey::filter
