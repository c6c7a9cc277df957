#pragma once

#include <Eigen/Core>

namespace marey::geometry {

/// A point or a direction in D dimensions; the unit (px or m) is the holder's.
template <int D>
using Vector = Eigen::Matrix<double, D, 1>;

/// A covariance or another D × D map, in the square of its holder's unit.
template <int D>
using Matrix = Eigen::Matrix<double, D, D>;

}  // namespace marey::geometry
