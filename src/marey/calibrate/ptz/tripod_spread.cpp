#include "marey/calibrate/ptz/tripod_spread.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace marey::calibrate::ptz {
namespace {

constexpr int kNumbers = geometry::Tripod::numbers;
constexpr double kMaxShift = 1;      // m: larger errors are scaled from this; numerical
constexpr double kMinEffect = 0.02;  // px at 1280, of an error: smaller effects are omitted; numerical
constexpr double kLoose = 12;        // of the cut-off, with outliers removed before; unswept
constexpr double kMaxRange = 150;    // m: farther ground is not used; numerical

struct ShiftedTripod {
  geometry::Tripod tripod;
  double scale;  // of its effects, to a standard deviation
};

/// Independent errors of the tripod, a standard deviation each.
std::vector<ShiftedTripod> errors_of_tripod(const geometry::Tripod& tripod, const Matrix<kNumbers>& covariance) {
  // In units in which each number moves the image alike.
  Vector<kNumbers> unit;
  unit << 0.1, 0.1, 0.1, 0.002, 0.002, 0.002, 0.1, 0.005;
  const Matrix<kNumbers> scaled = unit.cwiseInverse().asDiagonal() * covariance * unit.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix<kNumbers>> modes(scaled);
  std::vector<ShiftedTripod> result;
  for (int i = 0; i < kNumbers; ++i) {
    if (!(modes.eigenvalues()(i) > 1e-4)) continue;
    const Vector<kNumbers> step = unit.cwiseProduct(modes.eigenvectors().col(i)) * std::sqrt(modes.eigenvalues()(i));
    const double part =
        std::min({1.0, kMaxShift / std::max(1e-9, step.head<3>().norm()), 0.02 / std::max(1e-9, step.segment<3>(3).norm())});
    std::array<double, kNumbers> numbers = tripod.as_numbers();
    for (int k = 0; k < kNumbers; ++k) numbers[static_cast<std::size_t>(k)] += part * step(k);
    result.push_back({geometry::Tripod::of(numbers), 1 / part});
  }
  return result;
}

/// Places of the ground in view of a frame, half a dozen.
std::vector<Vector<3>> ground_in_view(const geometry::Tripod& tripod, const geometry::Heading& heading, cv::Size size) {
  std::vector<Vector<3>> ground;
  const Camera camera = geometry::camera_of(tripod, heading, size);
  for (const double x : {0.1, 0.5, 0.9}) {
    for (const double y : {0.35, 0.6, 0.9}) {
      const auto ray = camera.ray({x * size.width, y * size.height});
      if (!ray || ray->direction.z() > -1e-3) continue;
      const double range = -ray->origin.z() / ray->direction.z();
      if (range * ray->direction.norm() < kMaxRange) ground.push_back(ray->origin + range * ray->direction);
    }
  }
  return ground;
}

Vector<2> pixel_at(const geometry::Tripod& tripod, const geometry::Heading& heading, const Vector<3>& location, cv::Size size) {
  const auto numbers = tripod.as_numbers();
  const Vector<3> turned = heading.as_vector();
  return geometry::to_pixel(geometry::TripodFrame<double>(numbers.data(), turned.data()).detected(location), size);
}

/// Adds one error of the tripod, with the heading that goes with it, to a frame.
void add_error(const geometry::Tripod& tripod, const geometry::Heading& heading, const ShiftedTripod& other,
               const geometry::Heading& with, cv::Size size, TripodSpread& spread) {
  const Vector<3> turned = other.scale * (with.as_vector() - heading.as_vector());
  spread.heading += turned * turned.transpose();
  Matrix<3> information = 1e-9 * Matrix<3>::Identity();
  Vector<3> slope = Vector<3>::Zero();
  double all = 0, count = 0;
  for (const Vector<3>& location : ground_in_view(tripod, heading, size)) {
    const Vector<2> off = other.scale * (pixel_at(other.tripod, with, location, size) - pixel_at(tripod, heading, location, size));
    const auto by = pixel_by_heading(tripod, heading, size, location);
    information += by.transpose() * by, slope += by.transpose() * off;
    all += off.squaredNorm(), count += 2;
  }
  if (count < 6 || all < count * kMinEffect * kMinEffect) return;
  const Vector<3> like = information.ldlt().solve(slope);
  const double left = std::max(0.0, all - like.dot(slope)) / count;  // px², that no heading explains
  const double angle = std::sqrt(left) / (size.width / 2.0) * std::exp(-heading.log_focal);
  spread.location += like * like.transpose();
  spread.location(0, 0) += angle * angle, spread.location(1, 1) += angle * angle;
}

}  // namespace

std::vector<TripodSpread> spread_of_tripod(const std::vector<TurnRecord>& records, const std::vector<std::optional<Aim>>& smooth,
                                           const geometry::Tripod& tripod, const Matrix<geometry::Tripod::numbers>& covariance,
                                           cv::Size size, const SmoothOptions& options) {
  std::vector<TripodSpread> spread(records.size());
  SmoothOptions loose = options;
  loose.aim.cut_off *= kLoose;  // what agreed with the tripod is all of its error that a shifted one has to follow
  const auto headings = smooth_ptz(records, tripod, size, loose);
  for (const ShiftedTripod& other : errors_of_tripod(tripod, covariance)) {
    const auto others = smooth_ptz(records, other.tripod, size, loose);
    for (std::size_t i = 0; i < records.size(); ++i) {
      if (smooth[i] && headings[i] && others[i])
        add_error(tripod, headings[i]->heading, other, others[i]->heading, size, spread[i]);
    }
  }
  return spread;
}

}  // namespace marey::calibrate::ptz
