#include "marey/calibrate/pitch/pitch_deviation.h"

#include <array>

#include <Eigen/LU>
#include <ceres/jet.h>

#include "marey/geometry/ground_view.h"

namespace marey::calibrate::pitch {

std::optional<Matrix<2>> position_covariance(const PitchFit& fit, std::size_t index, const Vector<2>& ground) {
  using geometry::GroundSurface;
  constexpr int kCameraNumbers = CameraNumbers::count, kGroundTerms = GroundSurface::kTerms;
  constexpr int kAll = kCameraNumbers + kGroundTerms;
  using Jet = ceres::Jet<double, kAll>;
  const GroundView view(fit.cameras[index], fit.ground);
  const auto pixel = view.pixel(ground);
  const auto location = pixel ? view.location(*pixel) : std::nullopt;
  if (!location) return std::nullopt;
  const CameraNumbers numbers = CameraNumbers::of(fit.cameras[index]);
  std::array<Jet, kAll> p;
  for (int i = 0; i < kAll; ++i) {
    const auto at = static_cast<std::size_t>(i);
    p[at] = Jet(i < kCameraNumbers ? numbers.p[at] : fit.ground.terms()[at - kCameraNumbers], i);
  }
  const auto detected = project_ground(p.data(), ground, GroundSurface::height_at(fit.ground.relative(ground), &p[kCameraNumbers]));
  Eigen::Matrix<double, 2, kAll> by_numbers;
  by_numbers << detected.x().v.transpose(), detected.y().v.transpose();
  const auto own = static_cast<Eigen::Index>(index) * kCameraNumbers, shared = fit.covariance.rows() - kGroundTerms;
  Eigen::Matrix<double, kAll, kAll> covariance;
  covariance << fit.covariance.block<kCameraNumbers, kCameraNumbers>(own, own),
      fit.covariance.block<kCameraNumbers, kGroundTerms>(own, shared),
      fit.covariance.block<kGroundTerms, kCameraNumbers>(shared, own),
      fit.covariance.block<kGroundTerms, kGroundTerms>(shared, shared);
  const Eigen::Matrix<double, 2, kAll> by = location->by_pixel * by_numbers;
  return Matrix<2>(by * covariance * by.transpose());
}

}  // namespace marey::calibrate::pitch
