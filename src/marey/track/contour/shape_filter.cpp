// The Kalman filter of the control points. A measurement line gives one number, where the curve lies along the line's direction n;
// the curve there is a weighted mean of k control points, so h has 2k entries that are not zero, and each line is taken in by
// itself: no matrix is inverted. Cost a line: 2k columns of P and one update of rank 1, (2M)² products.
// References: Arnaut & Costa 2009, section 3 (prediction); Blake & Isard, "Active Contours", 1998, ch. 6 and 10 (a spline corrected
// from lines one after another, noise that moves neighbouring control points alike).
#include "marey/track/contour/shape_filter.h"

#include <cmath>
#include <utility>

namespace marey::track::contour {
namespace {

constexpr double kAlikeOver = 1.5;  // control points: how far along the curve neighbours move alike

}  // namespace

ShapeFilter::ShapeFilter(const geometry::ClosedSpline& spline, double deviation)
    : ShapeFilter(spline, std::vector<double>(static_cast<std::size_t>(spline.count()), deviation)) {}

ShapeFilter::ShapeFilter(geometry::ClosedSpline spline, std::span<const double> deviations) : spline_(std::move(spline)) {
  const int count = spline_.count();
  P_ = Eigen::MatrixXd::Zero(2 * count, 2 * count);
  for (int i = 0; i < count; ++i) {
    const double deviation = deviations[static_cast<std::size_t>(i)];
    P_(i, i) = P_(count + i, count + i) = deviation * deviation;
  }
  gain_.resize(2 * count);
  out_.resize(2 * count);
  alike_.resize(count);
  for (int i = 0; i < count; ++i) {
    const double apart = std::min(i, count - i);
    alike_[i] = std::exp(-0.5 * apart * apart / (kAlikeOver * kAlikeOver));
  }
}

void ShapeFilter::predict(const Vector<2>& shift, double growth, const Vector<2>& centre, const ShapeNoise& noise) {
  const int count = spline_.count();
  for (int i = 0; i < count; ++i) {
    Vector<2>& point = spline_.control_points()[i];
    const Vector<2> arm = point - centre;
    out_[i] = arm.x();
    out_[count + i] = arm.y();
    point += shift + growth * arm;
  }
  P_ *= (1 + growth) * (1 + growth);
  const double together = noise.together * noise.together, bend = noise.bend * noise.bend, shared = noise.shift * noise.shift;
  for (int axis = 0; axis < 2; ++axis) {
    for (int i = 0; i < count; ++i) {
      double* column = &P_(axis * count, axis * count + i);
      for (int j = 0; j < count; ++j) column[j] += together * alike_[i < j ? j - i : i - j] + shared;
      column[i] += bend;
    }
  }
  P_.noalias() += noise.growth * noise.growth * out_ * out_.transpose();
}

double ShapeFilter::project(const geometry::SplineWeights& location, const Vector<2>& normal) const {
  const int count = spline_.count();
  gain_.setZero();
  for (int j = 0; j < spline_.order(); ++j) {
    const int i = location.first + j < count ? location.first + j : location.first + j - count;
    gain_.noalias() += location.value[j] * normal.x() * P_.col(i);
    gain_.noalias() += location.value[j] * normal.y() * P_.col(count + i);
  }
  double variance = 0;
  for (int j = 0; j < spline_.order(); ++j) {
    const int i = location.first + j < count ? location.first + j : location.first + j - count;
    variance += location.value[j] * (normal.x() * gain_[i] + normal.y() * gain_[count + i]);
  }
  return variance;
}

double ShapeFilter::variance(const geometry::SplineWeights& location, const Vector<2>& normal) const {
  return project(location, normal);
}

bool ShapeFilter::correct(const geometry::SplineWeights& location, const Vector<2>& normal, double position, double noise,
                          double gate) {
  const int count = spline_.count();
  double predicted = 0;
  for (int j = 0; j < spline_.order(); ++j) {
    const int i = location.first + j < count ? location.first + j : location.first + j - count;
    predicted += location.value[j] * normal.dot(std::as_const(spline_).control_points()[i]);
  }
  const double S = project(location, normal) + noise;
  const double innovation = position - predicted;
  if (innovation * innovation > gate * gate * S) return false;
  for (int i = 0; i < count; ++i) {
    spline_.control_points()[i] += innovation / S * Vector<2>(gain_[i], gain_[count + i]);
  }
  for (int i = 0; i < 2 * count; ++i) P_.col(i).noalias() -= gain_[i] / S * gain_;  // symmetric to the last bit, as it began
  return true;
}

Vector<2> ShapeFilter::deviation(int control_point) const {
  const int count = spline_.count();
  return {std::sqrt(std::max(0.0, P_(control_point, control_point))),
          std::sqrt(std::max(0.0, P_(count + control_point, count + control_point)))};
}

Matrix<2> ShapeFilter::centroid_covariance() const {
  const int count = spline_.count();
  const auto interleaved = spline_.centroid_gradient();
  Eigen::Matrix<double, 2, Eigen::Dynamic> gradient(2, 2 * count);
  for (int i = 0; i < count; ++i) {
    gradient.col(i) = interleaved.col(2 * i);
    gradient.col(count + i) = interleaved.col(2 * i + 1);
  }
  return gradient * P_ * gradient.transpose();
}

}  // namespace marey::track::contour
