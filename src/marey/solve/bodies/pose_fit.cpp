#include "marey/solve/bodies/pose_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "marey/geometry/layout.h"

namespace marey::solve::bodies {
namespace {

constexpr int kCorrections = 3;

void assess(std::span<const Vector<3>> locations, std::span<const Vector<3>> detected, PoseFit& fit) {
  fit.mean_error = fit.sum_of_squares = 0;
  for (std::size_t i = 0; i < locations.size(); ++i) {
    const double square = (fit.world_from_body * locations[i] - detected[i]).squaredNorm();
    fit.sum_of_squares += square;
    fit.mean_error += std::sqrt(square) / static_cast<double>(locations.size());
  }
}

}  // namespace

Matrix<3> skew(const Vector<3>& v) {
  return Matrix<3>{{0, -v.z(), v.y()}, {v.z(), 0, -v.x()}, {-v.y(), v.x(), 0}};
}

std::optional<PoseFit> fit_pose(std::span<const Vector<3>> locations, std::span<const Vector<3>> detected, double sigma,
                                double loosest_turn) {
  if (locations.size() < 3) return std::nullopt;
  const auto count = static_cast<double>(locations.size());
  Vector<3> centre = Vector<3>::Zero();
  for (const Vector<3>& location : locations) centre += location / count;
  Matrix<3> spread = Matrix<3>::Zero();  // Σ |q|² I − q qᵀ, in the body's frame
  for (const Vector<3>& location : locations) {
    const Vector<3> q = location - centre;
    spread += q.squaredNorm() * Matrix<3>::Identity() - q * q.transpose();
  }
  Matrix<3> inverse;
  bool invertible = false;
  spread.computeInverseWithCheck(inverse, invertible, 1e-30);
  if (!invertible || sigma * sigma * inverse.trace() > loosest_turn * loosest_turn) return std::nullopt;
  PoseFit fit;
  fit.world_from_body = geometry::rigid_fit(locations, detected);
  assess(locations, detected, fit);
  const Matrix<3>& R = fit.world_from_body.rotation;
  const Matrix<3> turn = sigma * sigma * R * inverse * R.transpose();
  const Matrix<3> lever = skew(R * centre);  // the origin is moved by shift − turn × lever arm
  fit.covariance.topLeftCorner<3, 3>() = turn;
  fit.covariance.topRightCorner<3, 3>() = turn * lever.transpose();
  fit.covariance.bottomLeftCorner<3, 3>() = lever * turn;
  fit.covariance.bottomRightCorner<3, 3>() = lever * turn * lever.transpose() + sigma * sigma / count * Matrix<3>::Identity();
  return fit;
}

PoseFit correct_pose(const PoseBelief& belief, std::span<const Vector<3>> locations, std::span<const Vector<3>> detected,
                     double sigma) {
  PoseFit fit;
  fit.world_from_body = belief.world_from_body;
  Vector<6> prior;  // information
  prior << Vector<3>::Constant(1 / belief.turn_variance), Vector<3>::Constant(1 / belief.position_variance);
  Matrix<6> information = prior.asDiagonal();
  for (int round = 0; round < kCorrections; ++round) {
    Rigid3& pose = fit.world_from_body;
    Vector<6> from_belief;
    from_belief << geometry::angle_axis_of(pose.rotation * belief.world_from_body.rotation.transpose()),
        pose.translation - belief.world_from_body.translation;
    Vector<6> gradient = prior.cwiseProduct(-from_belief);
    information = prior.asDiagonal();
    for (std::size_t i = 0; i < locations.size(); ++i) {
      const Vector<3> arm = pose.rotation * locations[i];
      Eigen::Matrix<double, 3, 6> J;
      J << -skew(arm), Matrix<3>::Identity();
      information += J.transpose() * J / (sigma * sigma);
      gradient += J.transpose() * (detected[i] - arm - pose.translation) / (sigma * sigma);
    }
    if (locations.empty()) break;
    const Vector<6> step = information.llt().solve(gradient);
    pose.rotation = geometry::rotation_from(step.head<3>()) * pose.rotation;
    pose.translation += step.tail<3>();
  }
  fit.covariance = information.llt().solve(Matrix<6>::Identity());
  assess(locations, detected, fit);
  return fit;
}

}  // namespace marey::solve::bodies
