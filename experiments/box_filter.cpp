// Xu et al.'s filter, in frames: the centre moves at constant velocity, the edges keep their distance from it. The measurement is
// linear in the state, r₁ = r_c + Δr₁ and so on, so that one Kalman step takes in centre and edges together.
#include "experiments/box_filter.h"

#include <cmath>

#include <Eigen/LU>

namespace marey::experiments {
namespace {

using Measurement = Eigen::Matrix<double, 6, 1>;
using MeasurementMatrix = Eigen::Matrix<double, 6, 8>;

/// r_c c_c r₁ c₁ r₂ c₂: the edges as the box's first and last row and column.
Measurement measurement_of(const Box& box, const Vector<2>& centre) {
  Measurement z;
  z << centre.y(), centre.x(), box.top, box.left, box.bottom() - 1, box.right() - 1;
  return z;
}

MeasurementMatrix measurement_matrix() {
  MeasurementMatrix H = MeasurementMatrix::Zero();
  H(0, 0) = H(1, 1) = 1;
  for (int edge = 0; edge < 4; ++edge) {
    H(2 + edge, edge % 2) = 1;
    H(2 + edge, 4 + edge) = 1;
  }
  return H;
}

}  // namespace

BoxFilter::BoxFilter(const BoxFilterOptions& options, const Box& first, const Vector<2>& centre) : options_(options) {
  const Measurement z = measurement_of(first, centre);
  x_ << z[0], z[1], 0, 0, z[2] - z[0], z[3] - z[1], z[4] - z[0], z[5] - z[1];
  const double location = options.position_noise * options.position_noise;
  P_ = location * Eigen::Matrix<double, 8, 8>::Identity();
  P_.bottomRightCorner<4, 4>() *= 2;
  P_(2, 2) = P_(3, 3) = options.initial_velocity * options.initial_velocity;
}

void BoxFilter::step(const std::optional<Box>& box, const std::optional<Vector<2>>& centre) {
  Eigen::Matrix<double, 8, 8> A = Eigen::Matrix<double, 8, 8>::Identity();
  A(0, 2) = A(1, 3) = 1;
  x_ = A * x_;
  P_ = A * P_ * A.transpose();
  for (int i = 0; i < 8; ++i) {
    const double sigma = i < 2 ? 0 : i < 4 ? options_.velocity_noise : options_.size_noise;
    P_(i, i) += sigma * sigma;
  }
  const Box own = this->box();
  frozen_ = !box || !centre || std::abs(box->width - own.width) > options_.largest_change * own.width ||
            std::abs(box->height - own.height) > options_.largest_change * own.height;
  if (frozen_) return;
  const MeasurementMatrix H = measurement_matrix();
  const Eigen::Matrix<double, 6, 6> S =
      H * P_ * H.transpose() + options_.position_noise * options_.position_noise * Eigen::Matrix<double, 6, 6>::Identity();
  const Eigen::Matrix<double, 8, 6> K = P_ * H.transpose() * S.inverse();
  x_ += K * (measurement_of(*box, *centre) - H * x_);
  P_ -= K * S * K.transpose();
  P_ = (P_ + P_.transpose()).eval() / 2;
}

Box BoxFilter::box() const {
  return {x_[1] + x_[5], x_[0] + x_[4], x_[7] - x_[5] + 1, x_[6] - x_[4] + 1};
}
Vector<2> BoxFilter::centre() const {
  return {x_[1], x_[0]};
}
Vector<2> BoxFilter::velocity() const {
  return {x_[3], x_[2]};
}

}  // namespace marey::experiments
