#include "marey/calibrate/people/clock_drift.h"

#include <cmath>
#include <optional>

#include <Eigen/Cholesky>

#include "marey/geometry/camera.h"

namespace marey::calibrate::people {
namespace {

constexpr double kDriftPrior = 50e-6;  // physical: crystals of cameras and phones agree to tens of parts per million

/// Normal equations of offset and drift of each free camera, px² of error.
class ClockEquations {
 public:
  ClockEquations(const bundle::Bundle& bundle) : bundle_(bundle) {
    Eigen::Index free = 0;
    for (const bundle::BundleCamera& camera : bundle.cameras) {
      cameras_.emplace_back(camera.lens, camera.camera_from_world, cv::Size());
      column_.push_back(camera.refine_offset ? 2 * free++ : -1);
    }
    normal.setZero(2 * free, 2 * free);
    right.setZero(2 * free);
  }

  Eigen::Index column(std::size_t camera) const { return column_[camera]; }
  void add(const std::vector<std::size_t>& seen, const std::vector<std::optional<Vector<2>>>& errors, double time_s);

  Eigen::MatrixXd normal;
  Eigen::VectorXd right;

 private:
  const bundle::Bundle& bundle_;
  std::vector<Camera> cameras_;
  std::vector<Eigen::Index> column_;  // of a camera's offset, its drift behind it; −1: held
};

/// A body's observations, by their numbers: error = velocity · τ + by_place · place, the place eliminated.
void ClockEquations::add(const std::vector<std::size_t>& seen, const std::vector<std::optional<Vector<2>>>& errors, double time_s) {
  if (seen.size() < 2) return;
  const auto rows = static_cast<Eigen::Index>(2 * seen.size());
  Eigen::MatrixXd by_clock = Eigen::MatrixXd::Zero(rows, right.size()), by_place(rows, 3);
  Eigen::VectorXd error(rows);
  for (std::size_t k = 0; k < seen.size(); ++k) {
    const bundle::BundleObservation& one = bundle_.observations[seen[k]];
    const auto camera = static_cast<std::size_t>(one.camera);
    const auto projected = cameras_[camera].project_with_jacobian(bundle::marker_position(bundle_, one));
    if (!projected) return;
    const auto row = static_cast<Eigen::Index>(2 * k);
    by_place.middleRows<2>(row) = projected->by_world;
    error.segment<2>(row) = *errors[seen[k]];
    if (column_[camera] >= 0) by_clock.block<2, 2>(row, column_[camera]) << one.velocity, time_s * one.velocity;
  }
  const Eigen::LDLT<Matrix<3>> place(by_place.transpose() * by_place);
  if (place.info() != Eigen::Success || !place.isPositive()) return;
  const Eigen::MatrixXd seen_by_place = by_place.transpose() * by_clock;
  normal += by_clock.transpose() * by_clock - seen_by_place.transpose() * place.solve(seen_by_place);
  right += by_clock.transpose() * error - seen_by_place.transpose() * place.solve(by_place.transpose() * error);
}

}  // namespace

std::vector<ClockCorrection> clock_corrections(const bundle::Bundle& bundle, const bundle::BundleResult& fitted,
                                               const std::vector<double>& times_s, const std::vector<double>& drifts) {
  const auto errors = bundle::errors_of(bundle);
  ClockEquations equations(bundle);
  std::vector<std::size_t> seen;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (fitted.inlier[i] && errors[i]) seen.push_back(i);
    const int body = bundle.observations[i].body;
    if (i + 1 < errors.size() && bundle.observations[i + 1].body == body) continue;
    equations.add(seen, errors, times_s[static_cast<std::size_t>(body)]);
    seen.clear();
  }
  const double variance = fitted.noise_px * fitted.noise_px;
  Eigen::MatrixXd normal = equations.normal / variance;
  Eigen::VectorXd right = equations.right / variance;
  for (std::size_t c = 0; c < bundle.cameras.size(); ++c) {
    const Eigen::Index column = equations.column(c);
    if (column < 0) continue;
    normal(column + 1, column + 1) += 1 / (kDriftPrior * kDriftPrior);
    right(column + 1) -= drifts[c] / (kDriftPrior * kDriftPrior);
  }
  std::vector<ClockCorrection> found(bundle.cameras.size());
  const Eigen::LLT<Eigen::MatrixXd> solver(normal);
  if (normal.size() == 0 || solver.info() != Eigen::Success) return found;
  const Eigen::VectorXd values = solver.solve(right);
  const Eigen::MatrixXd covariance = solver.solve(Eigen::MatrixXd::Identity(normal.rows(), normal.cols()));
  for (std::size_t c = 0; c < bundle.cameras.size(); ++c) {
    const Eigen::Index column = equations.column(c);
    if (column >= 0) found[c] = {values(column), values(column + 1), std::sqrt(covariance(column + 1, column + 1))};
  }
  return found;
}

}  // namespace marey::calibrate::people
