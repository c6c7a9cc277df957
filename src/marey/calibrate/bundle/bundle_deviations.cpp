#include "marey/calibrate/bundle/bundle_deviations.h"

#include <algorithm>
#include <map>
#include <memory>

#include <ceres/cost_function.h>

#include "marey/calibrate/bundle/bundle_residual.h"
#include "marey/geometry/decompositions.h"

namespace marey::calibrate::bundle {
namespace {

using Dense = Eigen::MatrixXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The free numbers of one camera: columns into pose (0–5), lens, offset, laid one after another.
struct FreeNumbers {
  std::vector<int> columns;  // of [pose | lens | offset]
  int first = 0;             // place of the first among all cameras' free numbers
};

std::vector<FreeNumbers> free_numbers_of_cameras(const Bundle& bundle, const std::vector<BundleCamera>& start) {
  std::vector<FreeNumbers> all;
  int first = 0;
  for (std::size_t c = 0; c < bundle.cameras.size(); ++c) {
    const BundleCamera& camera = bundle.cameras[c];
    FreeNumbers numbers{{}, first};
    for (int i = 0; camera.refine_pose && i < kPose; ++i) numbers.columns.push_back(i);
    const auto sigmas = lens_sigmas(start[c].lens, camera.freedom);
    for (std::size_t i = 0; i < sigmas.size(); ++i) {
      if (sigmas[i] != 0) numbers.columns.push_back(kPose + static_cast<int>(i));
    }
    if (camera.refine_offset) numbers.columns.push_back(kPose + static_cast<int>(sigmas.size()));
    first += static_cast<int>(numbers.columns.size());
    all.push_back(std::move(numbers));
  }
  return all;
}

/// Columns of a body's numbers along which it may move.
Dense tangent_of(const Body& body) {
  const auto* wand = std::get_if<WandPose>(&body);
  if (wand == nullptr) return Dense::Identity(body_numbers(body), body_numbers(body));
  Dense tangent = Dense::Zero(6, 5);
  tangent.topLeftCorner<3, 3>().setIdentity();
  const Vector<3> across = wand->direction.unitOrthogonal();
  tangent.block<3, 1>(3, 3) = across;
  tangent.block<3, 1>(3, 4) = wand->direction.cross(across);
  return tangent;
}

struct Derivatives {
  Dense by_camera, by_body;  // 2 × free numbers
};

Derivatives derivatives_of(const Bundle& bundle, const BundleObservation& detected, const FreeNumbers& free) {
  const BundleCamera& camera = bundle.cameras[static_cast<std::size_t>(detected.camera)];
  const Body& body = bundle.bodies[static_cast<std::size_t>(detected.body)];
  const auto marker = static_cast<std::size_t>(detected.marker);
  Vector<3> site = Vector<3>::Zero();
  if (body.index() == 1) site.x() = bundle.wand[marker];
  if (body.index() == 2) site = bundle.board[marker];
  const std::unique_ptr<ceres::CostFunction> cost(make_reprojection(camera.lens, body, site, detected, true));
  const auto pose = numbers_of(camera.camera_from_world), lens = numbers_of(camera.lens), where = numbers_of(body);
  const std::array<const double*, 4> blocks = {pose.data(), lens.data(), where.data(), &camera.offset_s};
  RowMajor by_pose(2, kPose), by_lens(2, lens.size()), by_body(2, where.size()), by_offset(2, 1);
  std::array<double*, 4> jacobians = {by_pose.data(), by_lens.data(), by_body.data(), by_offset.data()};
  Vector<2> error;
  cost->Evaluate(blocks.data(), error.data(), jacobians.data());
  Dense all(2, kPose + by_lens.cols() + 1);
  all << by_pose, by_lens, by_offset;
  Derivatives result{Dense(2, free.columns.size()), by_body * tangent_of(body)};
  for (std::size_t i = 0; i < free.columns.size(); ++i) {
    result.by_camera.col(static_cast<Eigen::Index>(i)) = all.col(free.columns[i]);
  }
  return result;
}

/// Adds one body's information about the cameras, the body itself eliminated.
void add_body(const Bundle& bundle, const std::vector<const BundleObservation*>& detected, const std::vector<FreeNumbers>& free,
              Dense& S) {
  std::map<int, Dense> W;  // by camera: free numbers × body's
  const Dense tangent = tangent_of(bundle.bodies[static_cast<std::size_t>(detected.front()->body)]);
  Dense V = Dense::Zero(tangent.cols(), tangent.cols());
  for (const BundleObservation* one : detected) {
    const FreeNumbers& numbers = free[static_cast<std::size_t>(one->camera)];
    const Derivatives d = derivatives_of(bundle, *one, numbers);
    const auto n = static_cast<Eigen::Index>(numbers.columns.size());
    S.block(numbers.first, numbers.first, n, n) += d.by_camera.transpose() * d.by_camera;
    V += d.by_body.transpose() * d.by_body;
    Dense& w = W.try_emplace(one->camera, Dense::Zero(n, V.cols())).first->second;
    w += d.by_camera.transpose() * d.by_body;
  }
  std::erase_if(W, [](const auto& camera) { return camera.second.size() == 0; });  // all of it is held
  if (W.empty()) return;
  for (const auto& [a, left] : W) {
    const Dense solved = geometry::solve_symmetric(V, left.transpose());  // body's × free numbers of a
    for (const auto& [b, right] : W) {
      S.block(free[static_cast<std::size_t>(b)].first, free[static_cast<std::size_t>(a)].first, right.rows(), left.rows()) -=
          right * solved;
    }
  }
}

/// Inverse on what is determined, after scaling to a unit diagonal.
Dense inverse_of_determined(const Dense& S) {
  const Eigen::VectorXd scale = S.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const auto eigen = geometry::eigenpairs<Eigen::Dynamic>(scale.asDiagonal() * S * scale.asDiagonal());
  Eigen::VectorXd inverse = eigen.values;
  const double minimum = 1e-11 * inverse.maxCoeff();
  for (double& value : inverse) value = value > minimum ? 1 / value : 0;
  return scale.asDiagonal() * eigen.vectors * inverse.asDiagonal() * eigen.vectors.transpose() * scale.asDiagonal();
}

CameraDeviation deviation_of(const BundleCamera& camera, const FreeNumbers& free, const Dense& covariance) {
  const auto lens_count = static_cast<int>(numbers_of(camera.lens).size());
  CameraDeviation deviation;
  const auto n = static_cast<Eigen::Index>(free.columns.size());
  const Dense own = covariance.block(free.first, free.first, n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const int at = free.columns[static_cast<std::size_t>(i)] - kPose;
    const double sigma = std::sqrt(std::max(0.0, own(i, i)));
    if (at < 0) continue;
    if (at == 0) deviation.focal = sigma / geometry::focal_of(camera.lens).x();
    if (at == 1) deviation.aspect = sigma / (geometry::focal_of(camera.lens).y() / geometry::focal_of(camera.lens).x());
    if (at == 2 || at == 3) deviation.principal[at - 2] = sigma;
    if (at >= kLensBase && at < lens_count) deviation.distortion[static_cast<std::size_t>(at - kLensBase)] = sigma;
    if (at == lens_count) deviation.offset_s = sigma;
  }
  if (camera.refine_pose) {
    const Rigid3& pose = camera.camera_from_world;
    const Eigen::Matrix<double, 6, 6> by_numbers = own.topLeftCorner<6, 6>();
    const Matrix<3> J = left_jacobian(geometry::angle_axis_of(pose.rotation));
    deviation.rotation = (J * by_numbers.topLeftCorner<3, 3>() * J.transpose()).diagonal().cwiseMax(0).cwiseSqrt();
    const Eigen::Matrix<double, 3, 6> by_pose = centre_by_pose(pose);
    deviation.centre = (by_pose * by_numbers * by_pose.transpose()).diagonal().cwiseMax(0).cwiseSqrt();
  }
  return deviation;
}

}  // namespace

std::vector<double> lens_sigmas(const geometry::Lens& start, const LensFreedom& freedom) {
  const std::vector<double> numbers = numbers_of(start);
  std::vector<double> sigmas = {freedom.focal * numbers[0], freedom.aspect * numbers[1], freedom.principal, freedom.principal};
  for (std::size_t i = kLensBase; i < numbers.size(); ++i) sigmas.push_back(freedom.distortion[i - kLensBase]);
  return sigmas;
}

Eigen::Matrix<double, 3, 6> centre_by_pose(const Rigid3& pose) {
  const Vector<3>& t = pose.translation;
  Matrix<3> cross;
  cross << 0, -t.z(), t.y(), t.z(), 0, -t.x(), -t.y(), t.x(), 0;
  const Matrix<3> back = pose.rotation.transpose();
  Eigen::Matrix<double, 3, 6> derivatives;
  derivatives << -back * cross * left_jacobian(geometry::angle_axis_of(pose.rotation)), -back;
  return derivatives;
}

int free_numbers(const Bundle& bundle, const std::vector<char>& inlier) {
  constexpr std::array unknowns = {3, 5, 6};
  std::vector<char> held(bundle.bodies.size(), 0);
  for (std::size_t i = 0; i < inlier.size(); ++i) {
    if (inlier[i]) held[static_cast<std::size_t>(bundle.observations[i].body)] = 1;
  }
  int count = 0;
  for (std::size_t b = 0; b < held.size(); ++b) count += held[b] ? unknowns[bundle.bodies[b].index()] : 0;
  for (const FreeNumbers& numbers : free_numbers_of_cameras(bundle, bundle.cameras))
    count += static_cast<int>(numbers.columns.size());
  return count;
}

std::vector<CameraDeviation> deviations_of(const Bundle& bundle, const std::vector<BundleCamera>& start,
                                           const std::vector<char>& inlier, double noise_px) {
  const auto free = free_numbers_of_cameras(bundle, start);
  const auto count = free.empty() ? 0 : free.back().first + static_cast<Eigen::Index>(free.back().columns.size());
  std::vector<CameraDeviation> deviations(bundle.cameras.size());
  if (count == 0) return deviations;
  Dense S = Dense::Zero(count, count);
  std::vector<std::vector<const BundleObservation*>> by_body(bundle.bodies.size());
  for (std::size_t i = 0; i < inlier.size(); ++i) {
    if (inlier[i]) by_body[static_cast<std::size_t>(bundle.observations[i].body)].push_back(&bundle.observations[i]);
  }
  for (const auto& detected : by_body) {
    if (!detected.empty()) add_body(bundle, detected, free, S);
  }
  for (std::size_t c = 0; c < free.size(); ++c) {
    const auto sigmas = lens_sigmas(start[c].lens, bundle.cameras[c].freedom);
    for (std::size_t i = 0; i < free[c].columns.size(); ++i) {
      const int lens_number = free[c].columns[i] - kPose;
      if (lens_number < 0 || lens_number >= static_cast<int>(sigmas.size())) continue;
      const double sigma = sigmas[static_cast<std::size_t>(lens_number)];
      const auto at = free[c].first + static_cast<Eigen::Index>(i);
      if (std::isfinite(sigma)) S(at, at) += noise_px * noise_px / (sigma * sigma);
    }
  }
  const Dense covariance = noise_px * noise_px * inverse_of_determined(S);
  for (std::size_t c = 0; c < free.size(); ++c) deviations[c] = deviation_of(bundle.cameras[c], free[c], covariance);
  return deviations;
}

}  // namespace marey::calibrate::bundle
